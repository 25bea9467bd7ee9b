// SPDX-License-Identifier: MIT
#include "engine/io/curves/load_curves.h"

#include "engine/base/text.h"

namespace catena::curves {
namespace {

constexpr std::uint64_t kMaxBytes = std::uint64_t{8} << 30;

/// Registry of formats, one line each.
struct Format {
  std::string_view ending;
  Result<CurveSet> (*parse)(std::string_view bytes, const std::string& name);
};
constexpr Format kFormats[] = {{".tck", parse_tck}, {".trk", parse_trk}, {".vtp", nullptr},   {".vtk", nullptr},
                               {".vtu", nullptr},   {".pvd", nullptr},   {".series", nullptr}};

const Format* format_of(std::string_view path) {
  for (const Format& format : kFormats)
    if (has_extension(path, format.ending)) return &format;
  return nullptr;
}

}  // namespace

bool is_curve_file(std::string_view path) { return format_of(path) != nullptr; }

const std::vector<std::string_view>& curve_endings() {
  static const std::vector<std::string_view> endings = [] {
    std::vector<std::string_view> all;
    for (const Format& format : kFormats) all.push_back(format.ending);
    return all;
  }();
  return endings;
}

Result<CurveSetPtr> load_curves(const std::string& path, int step) {
  const Format* format = format_of(path);
  const std::string wanted = "a file of curves (" + join_alternatives(curve_endings()) + ")";
  if (format == nullptr) return Error{one_line(path + ": has an unknown kind; " + wanted + " was expected")};
  if (format->parse == nullptr) {
    CATENA_TRY(CurveSet set, read_lines(path, step));
    return CurveSetPtr(std::make_shared<CurveSet>(std::move(set)));
  }
  CATENA_TRY(const std::string bytes, read_text_file(path, wanted, kMaxBytes));
  CATENA_TRY(CurveSet set, format->parse(bytes, path));
  return CurveSetPtr(std::make_shared<CurveSet>(std::move(set)));
}

}  // namespace catena::curves
