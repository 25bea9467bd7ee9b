// SPDX-License-Identifier: MIT
// Rows of `catena measure`: points, bins, levels and labels at the limits of numbers.
#include "tests/limits/limits_table.h"
#include "tests/limits/render_fixture.h"
#include "tests/support/nifti_file.h"
#include "tests/support/run_program.h"

namespace catena::extremes {
namespace measure_limits_test {

/// A grid of 8^3 floats: value(i) of each voxel.
template <class Value>
std::string grid(const Value& value) {
  test::NiftiFile file({8, 8, 8}, 16, 32);
  for (int i = 0; i < 512; ++i) file.append(static_cast<float>(value(i)));
  return file.bytes();
}

const std::string& ramp() {
  static const std::string bytes = grid([](int i) { return i % 8; });
  return bytes;
}

/// The table that the program writes, with a semicolon for each end of line; or its exit code and message.
std::string measured(const std::string& data, std::vector<std::string> options) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "d.nii", data);
  options.insert(options.begin(), {"measure", folder / "d.nii", "-o", folder / "out.csv"});
  const test::ProgramResult result = test::run_catena(options);
  std::string text = result.exit_code == 0 ? test::read_file(folder / "out.csv") : without_folder(result.err, folder);
  while (text.ends_with('\n')) text.pop_back();
  for (std::size_t at = 0; (at = text.find('\n', at)) != text.npos;) text.replace(at, 1, "; ");
  return result.exit_code == 0 ? text : "exit code " + std::to_string(result.exit_code) + ": " + text;
}

}  // namespace measure_limits_test

Group measure_rows() {
  using namespace measure_limits_test;
  const std::string exit = "exit code 2: catena: ";
  return {"Measurements",
          {
              {"MeasureAFarPoint", "`measure --point` at 1.7e308", "step,time,point,x,y,z,value; 0,,1,1.7e+308,0,0,",
               [] {
                 return measured(ramp(), {"--point", "1.7e308,0,0"});
               }},
              {"MeasureALineBeyondDoubles", "`measure --line` from -1e308 to 1e308",
               exit + "--line \"-1e308,0,0:1e308,0,0\": the distance of the points is no finite number",
               [] {
                 return measured(ramp(), {"--line", "-1e308,0,0:1e308,0,0"});
               }},
              {"MeasureALineWithoutLength", "`measure --line` from a point to itself", "length,x,y,z,value; 0,1,1,1,1; 0,1,1,1,1",
               [] {
                 return measured(ramp(), {"--line", "1,1,1:1,1,1", "--samples", "2"});
               }},
              {"MeasureBinsBeyondDoubles", "`measure --histogram 2 --range -1e308 1e308`",
               exit + "--range: LO < HI was expected, finite numbers",
               [] {
                 return measured(ramp(), {"--histogram", "2", "--range", "-1e308", "1e308"});
               }},
              {"MeasureBinsWithoutWidth", "`measure --histogram 1000 --range 0 1e-322`",
               exit + "d.nii: the range is too narrow for so many bins",
               [] {
                 return measured(ramp(), {"--histogram", "1000", "--range", "0", "1e-322"});
               }},
              {"MeasureOneValue", "`measure --histogram 2` of a constant grid", "lower,upper,count; 2.5,3,0; 3,3.5,512",
               [] {
                 return measured(grid([](int) { return 3; }), {"--histogram", "2"});
               }},
              {"MeasureAboveAllValues", "`measure --level 1e300`",
               exit + "d.nii: no voxel reaches the level 1e+300; a level of at most 7 was expected",
               [] {
                 return measured(ramp(), {"--level", "1e300"});
               }},
              {"MeasureBelowAllValues", "`measure --level -1e300` of a constant grid",
               "part,voxels,volume,surface,closed,valued_voxels,mean,deviation,min,max,x,y,z; "
               "1,512,512,,,512,3,0,3,3,3.5,3.5,3.5",
               [] {
                 return measured(grid([](int) { return 3; }), {"--level", "-1e300"});
               }},
              {"MeasureLabelsBeyondFloats", "`measure` of a label map with the label 2^24 + 2",
               exit + "d.nii: voxel 0 0 0 holds 16777218; a label map, whose voxels are integers up to 16777216, was expected; --level "
                      "measures other fields",
               [] { return measured(grid([](int) { return 16777218; }), {}); }},
              {"MeasureInfiniteValues", "`measure --histogram 1` of a grid with infinite values in every second voxel",
               "lower,upper,count; 0,7,256",
               [] {
                 return measured(grid([](int i) { return i / 8 % 2 ? HUGE_VAL : i % 8; }), {"--histogram", "1"});
               }},
              proved_elsewhere("Area, volume and open edges of the isosurface of noise, measured block by block",
                               "the bits of the surface that is stored as a whole", "MeasureIsosurface.EqualsTheStoredSurfaceBitForBit"),
          }};
}

}  // namespace catena::extremes
