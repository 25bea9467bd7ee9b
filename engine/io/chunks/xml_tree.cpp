// SPDX-License-Identifier: MIT
#include "engine/io/chunks/xml_tree.h"

#include <expat.h>
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <memory>

#include "engine/io/stores/store_protocol.h"

namespace catena::chunks {
namespace {

struct Builder {
  XML_Parser parser = nullptr;
  XmlNode root;  ///< Parent of the document's element.
  std::vector<XmlNode*> open{&root};
  int elements = 0;
};

std::string local_name(std::string_view name) { return std::string(name.substr(name.rfind(':') + 1)); }

void on_start(void* data, const XML_Char* name, const XML_Char** attributes) {
  constexpr int kMaxElements = 1'000'000;
  constexpr std::size_t kMaxDepth = 64;
  auto& builder = *static_cast<Builder*>(data);
  if (++builder.elements > kMaxElements || builder.open.size() > kMaxDepth) {
    ::XML_StopParser(builder.parser, XML_FALSE);
    return;
  }
  XmlNode& node = builder.open.back()->children.emplace_back();
  node.name = local_name(name);
  for (; attributes[0] != nullptr; attributes += 2) node.attributes[local_name(attributes[0])] = attributes[1];
  builder.open.push_back(&node);
}

void on_end(void* data, const XML_Char*) { static_cast<Builder*>(data)->open.pop_back(); }

void on_text(void* data, const XML_Char* text, int length) {
  static_cast<Builder*>(data)->open.back()->text.append(text, static_cast<std::size_t>(length));
}

}  // namespace

std::string XmlNode::attribute(const std::string& key) const {
  const auto found = attributes.find(key);
  return found == attributes.end() ? std::string() : found->second;
}

double XmlNode::number(const std::string& key, double otherwise) const {
  const std::vector<double> numbers = numbers_in(attribute(key));
  return numbers.size() == 1 ? numbers[0] : otherwise;
}

int XmlNode::count(const std::string& key) const {
  const double value = number(key, -1);
  return value >= 0 && value <= static_cast<double>(field::kMaxStoreAxis) && value == std::floor(value) ? static_cast<int>(value) : -1;
}

const XmlNode* XmlNode::find(std::string_view child) const {
  for (const XmlNode& node : children)
    if (node.name == child) return &node;
  return nullptr;
}

std::vector<const XmlNode*> XmlNode::all(std::string_view child) const {
  std::vector<const XmlNode*> found;
  for (const XmlNode& node : children)
    if (node.name == child) found.push_back(&node);
  return found;
}

Result<XmlNode> parse_xml(std::string_view text) {
  Builder builder;
  const std::unique_ptr<XML_ParserStruct, decltype(&::XML_ParserFree)> parser(::XML_ParserCreate(nullptr), &::XML_ParserFree);
  if (!parser) return Error{"there is not enough memory for the XML"};
  builder.parser = parser.get();
  ::XML_SetUserData(parser.get(), &builder);
  ::XML_SetElementHandler(parser.get(), on_start, on_end);
  ::XML_SetCharacterDataHandler(parser.get(), on_text);
  constexpr std::size_t kMaxBytes = 1 << 30;
  if (text.size() > kMaxBytes) return Error{"the XML is too large"};
  if (::XML_Parse(parser.get(), text.data(), static_cast<int>(text.size()), 1) != XML_STATUS_OK)
    return Error{fmt::format("the XML is damaged or too large (line {}: {})", ::XML_GetCurrentLineNumber(parser.get()),
                             ::XML_ErrorString(::XML_GetErrorCode(parser.get())))};
  return std::move(builder.root.children.front());
}

std::vector<double> numbers_in(const std::string& text) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at < end) {
    if (*at == ' ' || *at == '\n' || *at == '\t' || *at == '\r' || *at == '+') {
      ++at;
      continue;
    }
    double value = 0;
    const auto [stop, code] = std::from_chars(at, end, value);
    if (code != std::errc() || !std::isfinite(value)) return {};
    numbers.push_back(value);
    at = stop;
  }
  return numbers;
}

}  // namespace catena::chunks
