// SPDX-License-Identifier: MIT
#include "engine/io/chunks/ome_metadata.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "engine/base/json.h"
#include "engine/base/text.h"

namespace catena::chunks {
namespace {

using json::Kind;
using json::Node;

constexpr std::size_t kMaxDatasets = 64, kMaxChannels = 4096;

std::string text_of(const Node& object, std::string_view key) {
  const Node* found = object.find(key);
  return found != nullptr && found->kind == Kind::string ? found->string : std::string();
}

std::optional<double> number_of(const Node& object, std::string_view key) {
  const Node* found = object.find(key);
  return found != nullptr && found->kind == Kind::number ? std::optional(found->number) : std::nullopt;
}

/// Multiplies scales and adds translations of a list of transformations, in its order.
Outcome apply_transformations(const Node& owner, std::size_t axes, OmeDataset& dataset) {
  const Node* list = owner.find("coordinateTransformations");
  if (list == nullptr || list->kind != Kind::array) return Done{};
  for (const Node& item : list->items) {
    const std::string type = text_of(item, "type");
    if (type == "identity") continue;
    const Node* numbers = item.find(type);
    if ((type != "scale" && type != "translation") || numbers == nullptr || numbers->items.size() != axes)
      return json::error_at(item, fmt::format("expected a \"scale\" or a \"translation\" of {} numbers", axes));
    dataset.scale.resize(axes, 1.0);
    dataset.translation.resize(axes, 0.0);
    for (std::size_t i = 0; i < axes; ++i) {
      const Node& number = numbers->items[i];
      if (number.kind != Kind::number || (type == "scale" && !(number.number > 0)))
        return json::error_at(item, fmt::format("{}: expected {}numbers", in_quotes(type), type == "scale" ? "positive " : ""));
      if (type == "scale") {
        dataset.scale[i] *= number.number;
        dataset.translation[i] *= number.number;
      } else {
        dataset.translation[i] += number.number;
      }
    }
  }
  return Done{};
}

Outcome read_axes(const Node& image, OmeMetadata& out) {
  const Node* axes = image.find("axes");
  if (axes == nullptr) return Done{};
  std::string seen;
  for (const Node& item : axes->items) {
    const std::string name = item.kind == Kind::string ? item.string : text_of(item, "name");
    const bool known = name.size() == 1 && std::string_view("tczyx").find(name[0]) != std::string_view::npos;
    if (!known || seen.find(name) != std::string::npos)
      return json::error_at(item, fmt::format("the axis {} is not supported, expected t, c, z, y and x, each once", in_quotes(name)));
    seen += name;
    out.axes.push_back({name[0], item.kind == Kind::object ? text_of(item, "unit") : ""});
  }
  if (seen.find('y') == std::string::npos || seen.find('x') == std::string::npos)
    return json::error_at(*axes, "\"axes\": expected y and x among them");
  return Done{};
}

/// Returns whether a path leads to a folder below its own.
bool is_inner_path(const std::string& path) {
  return !path.empty() && path[0] != '/' && ("/" + path + "/").find("/../") == std::string::npos && path.size() < 1000 &&
         path.find('\0') == std::string::npos;
}

Outcome read_image(const Node& image, OmeMetadata& out) {
  out.is_image = true;
  out.name = text_of(image, "name");
  CATENA_CHECK(read_axes(image, out));
  const std::size_t axes = out.axes.empty() ? 5 : out.axes.size();
  const Node* datasets = image.find("datasets");
  if (datasets == nullptr || datasets->kind != Kind::array || datasets->items.empty() || datasets->items.size() > kMaxDatasets)
    return json::error_at(json::member_or_parent(image, "datasets"), fmt::format("\"datasets\": expected a list of 1 to {}", kMaxDatasets));
  for (const Node& item : datasets->items) {
    OmeDataset dataset{text_of(item, "path"), {}, {}};
    if (!is_inner_path(dataset.path)) return json::error_at(item, "\"path\": expected the name of an array in this group");
    CATENA_CHECK(apply_transformations(item, axes, dataset));
    CATENA_CHECK(apply_transformations(image, axes, dataset));
    out.datasets.push_back(std::move(dataset));
  }
  return Done{};
}

void read_channels(const Node& omero, OmeMetadata& out) {
  const Node* channels = omero.find("channels");
  if (channels == nullptr || channels->items.size() > kMaxChannels) return;
  for (const Node& item : channels->items) {
    OmeChannel channel;
    channel.label = text_of(item, "label");
    if (const Node* window = item.find("window")) {
      channel.lo = number_of(*window, "start");
      channel.hi = number_of(*window, "end");
    }
    const std::string color = text_of(item, "color");
    unsigned value = 0;
    constexpr std::size_t kDigits = 6;
    if (color.size() >= kDigits) {
      const char* const from = color.data() + color.size() - kDigits;
      if (std::from_chars(from, from + kDigits, value, 16).ptr == from + kDigits) channel.color = static_cast<int>(value);
    }
    out.channels.push_back(std::move(channel));
  }
}

}  // namespace

Result<OmeMetadata> parse_ome(const std::string& text, const std::string& name) {
  CATENA_TRY(const Node root, json::parse(text, name));
  OmeMetadata out;
  out.is_plate = root.find("plate") != nullptr;
  out.is_label = root.find("image-label") != nullptr;
  if (const Node* images = root.find("multiscales")) {
    if (images->kind != Kind::array || images->items.empty()) return json::error_at(*images, "\"multiscales\": expected a list of images");
    CATENA_CHECK(read_image(images->items.front(), out));
  }
  if (const Node* omero = root.find("omero")) read_channels(*omero, out);
  if (const Node* labels = root.find("labels"))
    for (const Node& item : labels->items)
      if (item.kind == Kind::string && is_inner_path(item.string)) out.labels.push_back(item.string);
  if (const Node* dimensions = root.find("_ARRAY_DIMENSIONS"))
    for (const Node& item : dimensions->items) out.dimensions.push_back(item.string);
  return out;
}

LengthUnit find_length_unit(const std::string& name) {
  struct Known {
    std::string_view names;  ///< each surrounded by blanks
    const char* shown;
    double meters;
  };
  static constexpr Known kKnown[] = {
      {" meter metre m ", "m", 1},
      {" centimeter cm ", "cm", 1e-2},
      {" millimeter millimetre mm ", "mm", 1e-3},
      {" micrometer micrometre micron microns um \xC2\xB5m \xCE\xBCm ", "µm", 1e-6},
      {" nanometer nanometre nm ", "nm", 1e-9},
      {" angstrom \xC3\x85 \xE2\x84\xAB ", "Å", 1e-10},
      {" picometer pm ", "pm", 1e-12},
      {" inch in ", "in", 0.0254},
      {" kilometer km ", "km", 1e3},
  };
  for (const Known& unit : kKnown)
    if (!name.empty() && unit.names.find(" " + name + " ") != std::string_view::npos) return {unit.shown, unit.meters};
  return {name, 0};
}

}  // namespace catena::chunks
