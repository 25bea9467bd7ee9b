// SPDX-License-Identifier: MIT
// Layouts with levels: BigDataViewer and Imaris.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "engine/io/chunks/hdf5_layouts.h"
#include "engine/io/chunks/ome_metadata.h"
#include "engine/io/chunks/xml_tree.h"

namespace catena::chunks {
namespace {

constexpr int kMaxLevels = 32, kMaxSteps = 100'000, kMaxSetups = 1000;

field::Index3 size_of(const H5Data& data) {
  return {static_cast<int>(data.size[2]), static_cast<int>(data.size[1]), static_cast<int>(data.size[0])};
}

/// An affine map in rows, as BigDataViewer writes it.
struct RowMap {
  Mat3 linear{1.0};
  Vec3 origin{0.0};
};
RowMap row_map(const std::vector<double>& rows) {
  RowMap map;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) map.linear[static_cast<int>(c)][static_cast<int>(r)] = rows[4 * r + c];
    map.origin[static_cast<int>(r)] = rows[4 * r + 3];
  }
  return map;
}

/// What the .xml states of a setup: name, unit, the map of level 0 to the world at the first time.
struct Setup {
  std::string name, unit;
  RowMap map;
};
Setup setup_in(const XmlNode* root, int number) {
  Setup setup;
  if (root == nullptr) return setup;
  const std::string id = std::to_string(number);
  const XmlNode* sequence = root->find("SequenceDescription");
  if (const XmlNode* setups = sequence != nullptr ? sequence->find("ViewSetups") : nullptr)
    for (const XmlNode* view : setups->all("ViewSetup")) {
      const XmlNode* own = view->find("id");
      if (own == nullptr || numbers_in(own->text) != std::vector<double>{static_cast<double>(number)}) continue;
      if (const XmlNode* name = view->find("name")) setup.name = name->text;
      const XmlNode* voxel = view->find("voxelSize");
      if (const XmlNode* unit = voxel != nullptr ? voxel->find("unit") : nullptr) setup.unit = find_length_unit(unit->text).name;
      const std::vector<double> sizes =
          voxel != nullptr && voxel->find("size") != nullptr ? numbers_in(voxel->find("size")->text) : std::vector<double>();
      for (int a = 0; a < 3 && sizes.size() == 3; ++a)
        if (sizes[static_cast<std::size_t>(a)] > 0) setup.map.linear[a][a] = sizes[static_cast<std::size_t>(a)];
    }
  // the registration replaces the voxel size; the last transform is applied first
  const XmlNode* registrations = root->find("ViewRegistrations");
  for (const XmlNode* view : registrations != nullptr ? registrations->all("ViewRegistration") : std::vector<const XmlNode*>()) {
    if (view->attribute("setup") != id) continue;
    RowMap all;
    bool has_map = false;
    for (const XmlNode* transform : view->all("ViewTransform")) {
      const XmlNode* affine = transform->find("affine");
      const std::vector<double> rows = affine != nullptr ? numbers_in(affine->text) : std::vector<double>();
      if (rows.size() != 12) continue;
      const RowMap one = row_map(rows);
      all.origin = all.linear * one.origin + all.origin;
      all.linear = all.linear * one.linear;
      has_map = true;
    }
    if (has_map && field::Mapping::from_linear(all.linear, all.origin).is_invertible()) setup.map = all;
    break;
  }
  return setup;
}

/// Returns the number in a name such as "t00012" after a letter; -1: another name.
int number_after(const std::string& name, char letter, std::size_t digits) {
  if (name.size() != digits + 1 || name[0] != letter || name.find_first_not_of("0123456789", 1) != std::string::npos) return -1;
  return std::stoi(name.substr(1));
}

/// Returns an Imaris attribute as a number; nullopt: there is none.
double imaris_number(const H5File& file, const std::string& object, const std::string& attribute, double otherwise) {
  const std::vector<double> numbers = numbers_in(file.text(object, attribute));
  return numbers.size() == 1 ? numbers.front() : otherwise;
}

}  // namespace

Result<H5Layout> find_bigdataviewer_grids(H5File& file, const std::string& xml) {
  H5Layout out;
  std::vector<int> setups, steps;
  for (const std::string& name : file.members("/")) {
    constexpr std::size_t kSetupDigits = 2, kStepDigits = 5;
    if (const int setup = number_after(name, 's', kSetupDigits); setup >= 0 && file.exists("/" + name + "/resolutions"))
      setups.push_back(setup);
    if (const int step = number_after(name, 't', kStepDigits); step >= 0) steps.push_back(step);
  }
  if (setups.empty() || steps.empty()) return out;
  std::ranges::sort(setups);
  std::ranges::sort(steps);
  XmlNode root;
  if (!xml.empty()) {
    auto parsed = parse_xml(xml);
    if (!parsed) return Error{"has an .xml beside it that cannot be used: " + parsed.error().message};
    root = std::move(*parsed);
  }
  for (const int number : setups) {
    const std::string setup = fmt::format("s{:02}", number), first = fmt::format("/t{:05}/{}", steps.front(), setup);
    const std::vector<double> factors = file.values("/" + setup + "/resolutions");
    if (factors.empty() || factors.size() % 3 != 0 || factors.size() / 3 > kMaxLevels)
      return Error{fmt::format("has invalid resolutions of {}, expected three numbers a level", in_quotes(setup))};
    const Setup stated = setup_in(xml.empty() ? nullptr : &root, number);
    H5Grid grid;
    grid.description.name = stated.name.empty() ? fmt::format("setup {}", number) : stated.name;
    grid.description.length_unit = stated.unit;
    grid.description.steps = static_cast<std::int32_t>(steps.size());
    grid.is_unsigned = true;
    for (std::size_t level = 0; level < factors.size() / 3; ++level) {
      const std::string path = fmt::format("{}/{}/cells", first, level);
      const auto found = file.data(path);
      if (!found) return Error{fmt::format("has a data set {} that {}", in_quotes(path), found.error().message)};
      if ((*found)->size.size() != 3) return Error{fmt::format("has a data set {} that has not three axes", in_quotes(path))};
      // voxels of a level are centered in the voxels of level 0 that they cover
      Mat3 scale(1.0);
      Vec3 shift(0.0);
      for (int a = 0; a < 3; ++a) {
        const double factor = factors[3 * level + static_cast<std::size_t>(a)];
        scale[a][a] = factor;
        shift[a] = (factor - 1) / 2;
      }
      grid.description.levels.push_back(
          {size_of(**found),
           {1, 1, 1},
           field::Mapping::from_linear(stated.map.linear * scale, stated.map.linear * shift + stated.map.origin)});
      std::vector<std::string>& paths = grid.paths.emplace_back();
      for (const int step : steps) paths.push_back(fmt::format("/t{:05}/{}/{}/cells", step, setup, level));
    }
    out.grids.push_back(std::move(grid));
  }
  for (const int step : steps)
    if (steps.size() > 1) out.times.push_back(step);
  return out;
}

Result<H5Layout> find_imaris_grids(H5File& file) {
  H5Layout out;
  const auto path_of = [](int level, int step, int channel) {
    return fmt::format("/DataSet/ResolutionLevel {}/TimePoint {}/Channel {}", level, step, channel);
  };
  if (!file.exists(path_of(0, 0, 0) + "/Data")) return out;
  int steps = 1;
  while (steps < kMaxSteps && file.exists(path_of(0, steps, 0))) ++steps;
  const std::string image = "/DataSetInfo/Image";
  for (int channel = 0; channel < kMaxSetups && file.exists(path_of(0, 0, channel) + "/Data"); ++channel) {
    const std::string info = fmt::format("/DataSetInfo/Channel {}", channel);
    H5Grid grid;
    grid.description.name = file.text(info, "Name");
    if (grid.description.name.empty()) grid.description.name = fmt::format("channel {}", channel);
    grid.description.steps = steps;
    grid.description.length_unit = find_length_unit(file.text(image, "Unit")).name;
    const std::vector<double> range = numbers_in(file.text(info, "ColorRange")), color = numbers_in(file.text(info, "Color"));
    grid.description.has_window = range.size() == 2 && range[0] < range[1];
    if (grid.description.has_window) std::ranges::copy(range, grid.description.window);
    if (color.size() == 3) {
      const auto byte = [&](std::size_t i) { return static_cast<int>(std::lround(std::clamp(color[i], 0.0, 1.0) * 255)); };
      grid.description.color = byte(0) << 16 | byte(1) << 8 | byte(2);
    }
    for (int level = 0; level < kMaxLevels && file.exists(path_of(level, 0, channel) + "/Data"); ++level) {
      const std::string group = path_of(level, 0, channel);
      const auto found = file.data(group + "/Data");
      if (!found) return Error{fmt::format("has a data set {} that {}", in_quotes(group), found.error().message)};
      if ((*found)->size.size() != 3) return Error{fmt::format("has a data set {} that has not three axes", in_quotes(group))};
      // the data are padded to whole chunks
      field::Index3 size = size_of(**found);
      int* const own[3] = {&size.x, &size.y, &size.z};
      Mat3 linear(1.0);
      Vec3 origin(0.0);
      for (int a = 0; a < 3; ++a) {
        const double stated = imaris_number(file, group, std::string("ImageSize") + "XYZ"[a], *own[a]);
        if (stated >= 1 && stated <= *own[a]) *own[a] = static_cast<int>(stated);
        const double lo = imaris_number(file, image, fmt::format("ExtMin{}", a), 0);
        const double hi = imaris_number(file, image, fmt::format("ExtMax{}", a), lo);
        if (hi > lo) linear[a][a] = (hi - lo) / *own[a];
        origin[a] = lo + linear[a][a] / 2;
      }
      grid.description.levels.push_back({size, {1, 1, 1}, field::Mapping::from_linear(linear, origin)});
      std::vector<std::string>& paths = grid.paths.emplace_back();
      for (int step = 0; step < steps; ++step) paths.push_back(path_of(level, step, channel) + "/Data");
    }
    out.grids.push_back(std::move(grid));
  }
  for (int step = 0; step < steps && steps > 1; ++step) out.times.push_back(step);
  return out;
}

}  // namespace catena::chunks
