#!/usr/bin/perl
# SPDX-License-Identifier: MIT
# What Doxygen reads of a header, line by line: without what the compiler writes (= default, = delete), friends and plain destructors, and
# with a comment behind several declarations given to each of them, which Doxygen would give to the last alone.
use strict;
use warnings;

# "a = 1, b{2, 3}": its parts at commas outside of all brackets
sub declared {
  my ($depth, @parts) = (0, '');
  for my $c (split //, shift) {
    $depth++ if $c =~ /[({\[<]/;
    $depth-- if $c =~ /[)}\]>]/;
    if ($c eq ',' && $depth == 0) { push @parts, ''; next }
    $parts[-1] .= $c;
  }
  return @parts;
}

my $name = $ARGV[0];
while (<>) {
  $_ = "\n" if $. == 1;  # the licence
  s/^\/\/\/ /\/\/\/ \\file \"$name\"\n\/\/\/ / if $. == 2;  # what a header says of itself; warnings count one line more
  s/^[^\/]*(= default|= delete);.*$//;
  s/^\s*(virtual )?~\w+\(\)( override)?( noexcept)?;.*$//;
  s/^\s*friend .*$//;
  if (m{^(\s*)((?:(?:inline|static|constexpr) )*[\w:]+(?:<[^()]*?>+)?) (\w[^()]*,[^()]*|\w+\{[^;]*\}, \w+\{[^;]*\});\s*///<\s*(.*)$}) {
    my ($indent, $type, $names, $doc) = ($1, $2, $3, $4);
    my @all = declared($names);
    $_ = $indent . join(' ', map { s/^\s+//r =~ s/$/;/r =~ s/^/$type /r . " /**< $doc */" } @all) . "\n" if @all > 1;
  }
  print;
}
