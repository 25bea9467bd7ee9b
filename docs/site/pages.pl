#!/usr/bin/perl
# What Doxygen reads of a page of Markdown: each heading with an id that is unique in the site, and links that lead to it. In the plain files
# a link to "## The file" of study.md is study.md#the-file, here it is study-the-file.
use strict;
use warnings;

my $path = $ARGV[0];
my ($page) = $path =~ m{([^/]+)\.md$};
$page = 'viewer' if $path =~ m{viewer/README};
my ($fenced, %seen) = (0);
sub anchor { return lc(shift) =~ s/ /-/gr =~ s/[^a-z0-9_-]//gr }

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
    s/\]\((?:[\w.-]+\/)*([\w-]+)\.md#([\w-]+)\)/](#$1-$2)/g;
    s/\]\([\w.\/]*viewer\/README\.md\)/](#page-viewer)/g;
    s/\]\((?:\.\.\/)*README\.md\)/](index.html)/g;
    s/(!\[[^\]]*\]\()[\w.\/-]*\/([\w-]+\.(?:png|gif)\))/$1$2/g;  # Doxygen looks for pictures by their names
  }
  print;
}
