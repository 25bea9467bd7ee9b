#!/usr/bin/perl
# SPDX-License-Identifier: MIT
# What Doxygen reads of a page of Markdown: each heading with an id that is unique in the site, and links that lead to it. In the plain files
# a link to "## The file" of user/study.md is study.md#the-file, here it is user-study-the-file.
use strict;
use warnings;

my $root = $0 =~ s{docs/site/[^/]*$}{}r;  # ends with a slash, or is empty where Perl was started in the repository
my $path = $ARGV[0] =~ s{^\Q$root\E}{}r;
my ($folder) = $path =~ m{^(.*/)?};
$folder //= '';
# The id of a page: "docs/user/study.md" is user-study.
sub id_of { return lc(shift) =~ s{^docs/}{}r =~ s{\.md$}{}r =~ s{[^\w-]}{-}gr }
# The path from the root of a link on this page.
sub resolve {
  my $target = $folder . shift;
  1 while $target =~ s{(^|/)[^/.][^/]*/\.\./}{$1};
  return $target;
}
my $page = id_of($path);
my ($fenced, %seen) = (0);
sub anchor { return lc(shift) =~ s/ /-/gr =~ s/[^a-z0-9_-]//gr }
# Where a link to a page leads in the site.
sub link_to {
  my ($target, $heading) = @_;
  $target = resolve($target);
  return 'index.html' if $target eq 'README.md';
  return '#' . id_of($target) . '-' . ($heading // '') if defined $heading;
  return '#page-' . id_of($target);
}

while (<>) {
  $fenced = !$fenced if /^```/;
  s/^```(\w+)\s*$/$1 eq 'cpp' ? "```{.cpp}\n" : $1 eq 'python' ? "```{.py}\n" : "```\n"/e;
  if (!$fenced) {
    if (/^(#+) (.*\S)\s*$/) {
      my ($level, $text) = ($1, $2);
      my $id = $level eq '#' ? "page-$page" : "$page-" . anchor($text);
      $_ = "$level $text {#$id" . ($seen{$id}++ ? "-$seen{$id}" : '') . "}\n";
    }
    s/\]\(#([\w-]+)\)/](#$page-$1)/g;
    s/\]\(((?!http)[\w.\/-]+\.md)(?:#([\w-]+))?\)/'](' . link_to($1, $2) . ')'/ge;
    s{\]\((?:\.\./)+(examples(?:/[\w.-]*)?|LICENSE)\)}{]($1)}g;  # copied beside the pages
    s/(!\[[^\]]*\]\()(?:[\w.\/-]*\/)?([\w-]+\.(?:png|gif|svg)\))/$1$2/g;  # Doxygen looks for pictures by their names
  }
  print;
}
