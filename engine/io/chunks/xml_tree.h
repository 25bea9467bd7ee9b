// SPDX-License-Identifier: MIT
/// A small XML document as a tree, read by expat: OME-XML, the XML of BigDataViewer.
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace catena::chunks {

/// An element; names are without namespace prefix.
struct XmlNode {
  std::string name, text;
  std::map<std::string, std::string> attributes;
  std::vector<XmlNode> children;

  /// Returns an attribute; empty: there is none.
  std::string attribute(const std::string& key) const;
  /// Returns an attribute as a number, `otherwise` where there is none or it is not a finite number.
  double number(const std::string& key, double otherwise) const;
  /// Returns an attribute as a whole number within 0 .. 2^24; -1: there is none, or it is another one.
  int count(const std::string& key) const;
  /// Returns the first child of a name; null: none.
  const XmlNode* find(std::string_view child) const;
  /// Returns all children of a name.
  std::vector<const XmlNode*> all(std::string_view child) const;
};

/// Parses a document of at most 1 million elements, 64 deep. Returns an Error with a message fragment.
Result<XmlNode> parse_xml(std::string_view text);

/// Returns the numbers in a text, separated by blanks.
std::vector<double> numbers_in(const std::string& text);

}  // namespace catena::chunks
