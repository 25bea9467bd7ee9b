// SPDX-License-Identifier: MIT
// Opens PLY (Turk, 1994): text or binary in either byte order, elements with properties of any type. Vertices are read with x, y, z as
// doubles and their other scalar properties as values, also faces (polygons) and triangle strips; other elements are ignored. VTK's own
// reader rounds coordinates to single precision, which merges vertices far from the origin.
#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <sstream>

#include "engine/base/memory_limit.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/io/vtk/byte_order.h"
#include "engine/io/vtk/open.h"

namespace catena::vtk {
namespace {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::optional<PlyType> ply_type(std::string_view word) {
  static constexpr std::pair<std::string_view, PlyType> kWords[] = {
      {"char", PlyType::int8},   {"uchar", PlyType::uint8},   {"short", PlyType::int16},     {"ushort", PlyType::uint16},
      {"int", PlyType::int32},   {"uint", PlyType::uint32},   {"float", PlyType::float32},   {"double", PlyType::float64},
      {"int8", PlyType::int8},   {"uint8", PlyType::uint8},   {"int16", PlyType::int16},     {"uint16", PlyType::uint16},
      {"int32", PlyType::int32}, {"uint32", PlyType::uint32}, {"float32", PlyType::float32}, {"float64", PlyType::float64}};
  for (const auto& [name, type] : kWords)
    if (name == word) return type;
  return std::nullopt;
}

std::size_t byte_size(PlyType type) {
  static constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  std::optional<PlyType> list;  ///< type of the count before the numbers; empty: a single number
};
struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

/// Reads the numbers of the body in sequence.
class PlyNumbers {
 public:
  PlyNumbers(std::string_view bytes, bool text, bool big) : rest_(bytes), text_(text), big_(big) {}
  std::size_t left() const { return rest_.size(); }

  /// Returns false at the end of the file, or at a word that is not a number.
  bool next(PlyType type, double& out) {
    if (text_) {
      const std::size_t begin = rest_.find_first_not_of(" \t\r\n");
      if (begin == std::string_view::npos) return false;
      rest_.remove_prefix(begin);
      const std::size_t end = std::min(rest_.find_first_of(" \t\r\n"), rest_.size());
      const auto number = parse_double(rest_.substr(0, end));
      rest_.remove_prefix(end);
      out = number.value_or(0);
      return number.has_value();
    }
    const std::size_t bytes = byte_size(type);
    if (rest_.size() < bytes) return false;
    char raw[8];
    std::memcpy(raw, rest_.data(), bytes);
    if (big_ == (std::endian::native == std::endian::little)) std::reverse(raw, raw + bytes);
    rest_.remove_prefix(bytes);
    const auto as = [&]<class T>(T v) {
      std::memcpy(&v, raw, sizeof v);
      return static_cast<double>(v);
    };
    switch (type) {
      case PlyType::int8:
        out = as(std::int8_t{});
        break;
      case PlyType::uint8:
        out = as(std::uint8_t{});
        break;
      case PlyType::int16:
        out = as(std::int16_t{});
        break;
      case PlyType::uint16:
        out = as(std::uint16_t{});
        break;
      case PlyType::int32:
        out = as(std::int32_t{});
        break;
      case PlyType::uint32:
        out = as(std::uint32_t{});
        break;
      case PlyType::float32:
        out = as(float{});
        break;
      case PlyType::float64:
        out = as(double{});
        break;
    }
    return true;
  }

 private:
  std::string_view rest_;
  bool text_, big_;
};

/// Reads one file. Errors are message fragments.
class PlyReader {
 public:
  explicit PlyReader(std::string_view bytes) : bytes_(bytes) {}

  Result<vtkSmartPointer<vtkPolyData>> read() {
    CATENA_CHECK(read_header());
    // the file must be large enough for the elements: a number takes at least one byte, in text two
    PlyNumbers numbers(bytes_.substr(body_), text_, big_);
    points_->SetDataTypeToDouble();
    for (const PlyElement& element : elements_) {
      std::uint64_t min_bytes = 0;
      for (const PlyProperty& p : element.properties) min_bytes += text_ ? 1 : byte_size(p.list.value_or(p.type));
      if (min_bytes > 0 && element.count > numbers.left() / min_bytes)
        return Error{
            fmt::format("declares {} of \"{}\", more than the {} bytes of data can hold", element.count, element.name, numbers.left())};
      if (min_bytes > 0) CATENA_CHECK(read_element(element, numbers));
    }
    if (points_->GetNumberOfPoints() == 0) return Error{"has no vertices with x, y and z"};
    const auto poly = vtkSmartPointer<vtkPolyData>::New();
    poly->SetPoints(points_);
    if (polygons_->GetNumberOfCells() > 0) poly->SetPolys(polygons_);
    if (strips_->GetNumberOfCells() > 0) poly->SetStrips(strips_);
    for (const auto& array : values_) poly->GetPointData()->AddArray(array);
    if (!values_.empty()) poly->GetPointData()->SetActiveScalars(values_.front()->GetName());
    return poly;
  }

 private:
  Outcome read_header() {
    std::size_t at = 0;
    const auto next_line = [&](std::string_view& line) {
      constexpr std::size_t kMaxHeader = 1 << 20;
      const std::size_t end = bytes_.find_first_of("\r\n", at);
      if (end == std::string_view::npos || end > kMaxHeader) return false;
      line = bytes_.substr(at, end - at);
      at = end + (bytes_.substr(end, 2) == "\r\n" ? 2 : 1);
      return true;
    };
    std::string_view line;
    if (!next_line(line) || trim(line) != "ply") return Error{"does not begin with \"ply\""};
    bool known = false;
    while (true) {
      if (!next_line(line)) return Error{"has no \"end_header\""};
      std::istringstream words{std::string(line)};
      std::string word, a, b, c, d;
      words >> word >> a;
      if (word == "end_header") break;
      if (word == "format") {
        text_ = a == "ascii", big_ = a == "binary_big_endian";
        known = text_ || big_ || a == "binary_little_endian";
      } else if (word == "element") {
        const auto count = words >> b ? parse_integer(b) : std::nullopt;
        if (!count || *count < 0) return Error{"has an element without a count: " + in_quotes(line)};
        elements_.push_back({a, static_cast<std::uint64_t>(*count), {}});
      } else if (word == "property") {
        const bool list = a == "list";
        words >> b;
        if (list) words >> c >> d;
        const auto type = ply_type(list ? c : a);
        const auto count = list ? ply_type(b) : std::nullopt;
        const std::string& name = list ? d : b;
        if (elements_.empty() || !type || (list && !count) || name.empty()) return Error{"has an invalid property: " + in_quotes(line)};
        elements_.back().properties.push_back({name, *type, count});
      }
    }
    if (!known) return Error{"has no format line, or an unknown format; ascii, binary_little_endian or binary_big_endian was expected"};
    body_ = at;
    return Done{};
  }

  Outcome read_element(const PlyElement& element, PlyNumbers& numbers) {
    const bool vertices = element.name == "vertex";
    // destinations of a vertex's numbers: 0 to 2 are coordinates, 3 and more are values
    std::vector<int> targets(element.properties.size(), -1);
    if (vertices) {
      if (points_->GetNumberOfPoints() > 0) return Error{"has two elements \"vertex\""};
      CATENA_CHECK(
          check_memory_available("the vertices", static_cast<double>(element.count) * 8 * (3 + static_cast<double>(targets.size()))));
      int found = 0;
      for (std::size_t p = 0; p < targets.size(); ++p) {
        const PlyProperty& property = element.properties[p];
        if (property.list) continue;
        for (int axis = 0; axis < 3; ++axis)
          if (property.name == std::string(1, static_cast<char>('x' + axis))) targets[p] = axis, found |= 1 << axis;
        if (targets[p] < 0 && is_value(property.name)) {
          targets[p] = 3 + static_cast<int>(values_.size());
          const auto array = vtkSmartPointer<vtkFloatArray>::New();
          array->SetName(property.name.c_str());
          array->SetNumberOfTuples(static_cast<vtkIdType>(element.count));
          values_.push_back(array);
        }
      }
      if (found != 7) return Error{"has vertices without x, y and z"};
      points_->SetNumberOfPoints(static_cast<vtkIdType>(element.count));
    }
    std::vector<vtkIdType> corners;
    for (std::uint64_t n = 0; n < element.count; ++n) {
      double xyz[3] = {0, 0, 0};
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const PlyProperty& property = element.properties[p];
        const bool is_used = property.list && (element.name == "face" || element.name == "tristrips") &&
                             (property.name == "vertex_indices" || property.name == "vertex_index");
        double number = 0, count = 1;
        if (property.list && !numbers.next(*property.list, count)) return cut(element, n);
        corners.clear();
        if (!(count >= 0) || count > static_cast<double>(numbers.left())) return cut(element, n);
        for (double i = 0; i < count; ++i) {
          if (!numbers.next(property.type, number)) return cut(element, n);
          if (is_used) corners.push_back(static_cast<vtkIdType>(std::clamp(number, -2.0, 1e15)));
        }
        if (is_used) CATENA_CHECK(add_corners(element, n, corners));
        if (property.list || targets[p] < 0) continue;
        if (targets[p] < 3)
          xyz[targets[p]] = number;
        else
          values_[static_cast<std::size_t>(targets[p] - 3)]->SetValue(static_cast<vtkIdType>(n), static_cast<float>(number));
      }
      if (vertices) points_->SetPoint(static_cast<vtkIdType>(n), xyz);
    }
    return Done{};
  }

  Outcome add_corners(const PlyElement& element, std::uint64_t n, const std::vector<vtkIdType>& corners) {
    const bool strips = element.name == "tristrips";
    std::vector<vtkIdType> strip;
    const auto end_strip = [&] {
      if (strip.size() >= 3) strips_->InsertNextCell(static_cast<vtkIdType>(strip.size()), strip.data());
      strip.clear();
    };
    for (const vtkIdType corner : corners) {
      if (strips && corner == -1) {
        end_strip();
      } else if (corner < 0 || corner >= points_->GetNumberOfPoints()) {
        const std::string order = !text_ && looks_byte_swapped(*points_->GetData(), ".ply") ? "; " + byte_order_advice(".ply") : "";
        return Error{
            fmt::format("{} {} refers to vertex {}, expected 0 to {}{}", element.name, n, corner, points_->GetNumberOfPoints() - 1, order)};
      } else {
        strip.push_back(corner);
      }
    }
    if (strips)
      end_strip();
    else if (corners.size() >= 3)
      polygons_->InsertNextCell(static_cast<vtkIdType>(corners.size()), corners.data());
    return Done{};
  }

  /// Returns whether a property is a value; normals, colors and texture coordinates are not.
  static bool is_value(const std::string& name) {
    static constexpr std::string_view kLook[] = {
        "nx", "ny", "nz", "red", "green",     "blue",     "alpha", "diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha",
        "u",  "v",  "s",  "t",   "texture_u", "texture_v"};
    return std::find(std::begin(kLook), std::end(kLook), name) == std::end(kLook);
  }

  Error cut(const PlyElement& element, std::uint64_t n) const {
    return Error{fmt::format("is truncated or damaged: \"{}\" {} of {} is incomplete", element.name, n + 1, element.count)};
  }

  std::string_view bytes_;
  std::size_t body_ = 0;
  bool text_ = false, big_ = false;
  std::vector<PlyElement> elements_;
  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> polygons_, strips_;
  std::vector<vtkSmartPointer<vtkFloatArray>> values_;
};

}  // namespace

Result<ImportedData> open_ply(const Source& source) {
  constexpr std::uintmax_t kMaxBytes = std::uintmax_t{4} << 30;
  const auto bytes = read_text_file(source.path, "a PLY file", kMaxBytes);
  if (!bytes) return Error{one_line(source.display_name + ": cannot be read (" + bytes.error().message + ")")};
  const auto poly = PlyReader(*bytes).read();
  if (!poly) return Error{one_line(source.display_name + ": " + poly.error().message)};
  ImportedData opened;
  opened.blocks.push_back({*poly, {}});
  return opened;
}

}  // namespace catena::vtk
