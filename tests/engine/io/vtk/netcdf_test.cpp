// SPDX-License-Identifier: MIT
/// NetCDF files written by the NetCDF library: holes and values as the attributes of each variable define them.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <netcdf.h>

#include <array>
#include <cmath>
#include <set>

#include "engine/base/memory_limit.h"
#include "tests/engine/field/field_helpers.h"
#include "tests/fuzz/mutate.h"
#include "tests/fuzz/mutate_bytes.h"

namespace catena::field::netcdf_test {

constexpr int kZ = 2, kY = 3, kX = 4, kAll = kZ * kY * kX;

void check(int code) { ASSERT_EQ(code, NC_NOERR) << nc_strerror(code); }

/// An attribute with numbers, or with words.
struct Attribute {
  const char* name;
  nc_type type;
  std::vector<double> numbers{};
  std::string words{};
};

void put(int file, int v, const Attribute& a) {
  check(a.type == NC_CHAR ? nc_put_att_text(file, v, a.name, a.words.size(), a.words.data())
                          : nc_put_att_double(file, v, a.name, a.type, a.numbers.size(), a.numbers.data()));
}
void text(int file, int v, const char* name, const std::string& words) { put(file, v, {name, NC_CHAR, {}, words}); }

constexpr int kNetcdf3 = NC_CLASSIC_MODEL, kNetcdf4 = NC_NETCDF4;  // version 4: compressed and shuffled

/// A variable "v" over (z, y, x) with the values 0, 1, 2, ... and `special` values from index 5.
struct Case {
  const char* what;
  int format;
  nc_type type;
  std::vector<double> special;
  std::vector<Attribute> attributes;
  std::set<int> holes{};  ///< indices without a value
  double factor = 1, offset = 0;
  std::vector<std::pair<int, double>> values{};  ///< indices whose value is not factor * stored + offset
};

void write(const std::string& path, const Case& c) {
  int file = 0, dims[3] = {0, 0, 0}, v = 0;
  check(nc_create(path.c_str(), NC_CLOBBER | (c.format == NC_NETCDF4 ? NC_NETCDF4 : 0), &file));
  const std::size_t sizes[3] = {kZ, kY, kX};
  const char* names[3] = {"z", "y", "x"};
  for (int d = 0; d < 3; ++d) check(nc_def_dim(file, names[d], sizes[d], &dims[d]));
  check(nc_def_var(file, "v", c.type, 3, dims, &v));
  if (c.format == NC_NETCDF4) check(nc_def_var_deflate(file, v, 1, 1, 5));
  for (const Attribute& a : c.attributes) put(file, v, a);
  check(nc_enddef(file));
  std::vector<double> numbers(kAll);
  for (int i = 0; i < kAll; ++i) numbers[static_cast<std::size_t>(i)] = i;
  std::copy(c.special.begin(), c.special.end(), numbers.begin() + 5);
  if (c.type == NC_INT64) {  // a double cannot represent the type's default fill value
    std::vector<long long> whole(numbers.begin(), numbers.end());
    for (long long& n : whole) n = n == -9'000'000'000'000'000'000 ? NC_FILL_INT64 : n;
    check(nc_put_var_longlong(file, v, whole.data()));
  } else {
    check(nc_put_var_double(file, v, numbers.data()));
  }
  check(nc_close(file));
}

TEST(Netcdf, HolesAndValuesFollowTheAttributes) {
  const char *fill = "_FillValue", *missing = "missing_value", *factor = "scale_factor", *range = "valid_range";
  const Attribute is_unsigned{"_Unsigned", NC_CHAR, {}, "true"}, tenth{factor, NC_FLOAT, {.1F}};
  const std::vector<Case> cases = {
      {"packed fill",
       kNetcdf3,
       NC_SHORT,
       {-32768, -32767},
       {{fill, NC_SHORT, {-32768}}, {factor, NC_FLOAT, {.5F}}, {"add_offset", NC_FLOAT, {10}}},
       {5},
       .5,
       10},
      {"default fill", kNetcdf3, NC_SHORT, {-32767, -32768}, {}, {5}},
      {"default fill of 64 bits", kNetcdf4, NC_INT64, {-9e18}, {}, {5}},
      {"default fill of floats", kNetcdf4, NC_FLOAT, {NC_FILL_FLOAT, NAN}, {}, {5, 6}},
      {"bytes have none", kNetcdf3, NC_BYTE, {-127, -128}, {}},
      {"missing values, a list", kNetcdf4, NC_INT, {-99, -98, -97}, {{missing, NC_INT, {-99, -98}}}, {5, 6}},
      {"missing value of another type", kNetcdf3, NC_SHORT, {-999}, {{missing, NC_DOUBLE, {-999}}}, {5}},
      {"missing value as text", kNetcdf3, NC_FLOAT, {-999}, {{missing, NC_CHAR, {}, "-999.0"}}, {5}},
      {"double rounded to float", kNetcdf4, NC_FLOAT, {1e20F, -9999.9F}, {{missing, NC_DOUBLE, {1e20, -9999.9}}}, {5, 6}},
      {"float beside doubles", kNetcdf3, NC_DOUBLE, {-9999.9}, {{missing, NC_FLOAT, {-9999.9F}}}, {5}},
      {"both rounded", kNetcdf3, NC_DOUBLE, {1e20}, {{missing, NC_DOUBLE, {1e20F}}}, {5}},
      {"unsigned bytes",
       kNetcdf3,
       NC_BYTE,
       {-1, -2},
       {is_unsigned, {fill, NC_BYTE, {-1}}, {factor, NC_DOUBLE, {2}}},
       {5},
       2,
       0,
       {{6, 508}}},
      {"unsigned range", kNetcdf3, NC_BYTE, {-1, -56}, {is_unsigned, {range, NC_BYTE, {0, -56}}}, {5}, 1, 0, {{6, 200}}},
      {"true unsigned bytes", kNetcdf4, NC_UBYTE, {255}, {{fill, NC_UBYTE, {255}}}, {5}},
      {"range in stored units", kNetcdf3, NC_SHORT, {-7, 300}, {tenth, {range, NC_SHORT, {-5, 100}}}, {5, 6}, .1F},
      {"range in the values' units", kNetcdf4, NC_SHORT, {-7, 300}, {tenth, {range, NC_FLOAT, {-.5F, 10}}}, {5, 6}, .1F},
      {"least and most", kNetcdf3, NC_DOUBLE, {-1, 1000}, {{"valid_min", NC_DOUBLE, {0}}, {"valid_max", NC_DOUBLE, {999}}}, {5, 6}},
  };
  test::TemporaryFolder folder;
  for (const Case& c : cases) {
    const std::string path = folder / (c.format == NC_NETCDF4 ? "a.nc" : "a.cdf");
    write(path, c);
    std::vector<float> values(kAll, -1);
    test::read(path).scalar->grid()->read_block({0, 0, 0}, {kX, kY, kZ}, values);
    for (int i = 0; i < kAll; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double stored = i >= 5 && at - 5 < c.special.size() ? c.special[at - 5] : i;
      double wanted = c.factor * stored + c.offset;
      for (const auto& [place, value] : c.values) wanted = place == i ? value : wanted;
      if (c.holes.contains(i))
        EXPECT_TRUE(std::isnan(values[at])) << c.what << ": " << i << " is " << values[at];
      else
        EXPECT_NEAR(values[at], wanted, 1e-6 * std::fabs(wanted)) << c.what << ": " << i;
    }
  }
  write(folder / "n.nc", cases.back());
  const AnyField field = test::read(folder / "n.nc");
  ASSERT_EQ(field.notes.size(), 1u);
  EXPECT_TRUE(test::has_note(field, "2 of 24 values are outside the valid range of the file (0 .. 999)"));
}

/// Writes v(t, e, y, x) = 100 t + 12 e + n with coordinate variables: y decreases, x is packed; and a variable w(y).
void write_axes(const std::string& path) {
  int file = 0, dims[4] = {0, 0, 0, 0}, v = 0, y = 0, x = 0, t = 0, w = 0, group = 0, inner = 0;
  check(nc_create(path.c_str(), NC_CLOBBER | NC_NETCDF4, &file));
  const char* names[4] = {"time", "e", "lat", "x"};
  const std::size_t sizes[4] = {NC_UNLIMITED, 1, kY, kX};
  for (int d = 0; d < 4; ++d) check(nc_def_dim(file, names[d], sizes[d], &dims[d]));
  check(nc_def_var(file, "v", NC_SHORT, 4, dims, &v));
  check(nc_def_var(file, "time", NC_DOUBLE, 1, dims, &t));
  text(file, t, "units", "hours since 2000-01-01");
  check(nc_def_var(file, "lat", NC_DOUBLE, 1, dims + 2, &y));
  text(file, y, "units", "degrees_north");
  check(nc_def_var(file, "x", NC_SHORT, 1, dims + 3, &x));
  put(file, x, {"scale_factor", NC_DOUBLE, {.5}});
  put(file, x, {"add_offset", NC_DOUBLE, {100}});
  check(nc_def_var(file, "w", NC_FLOAT, 1, dims + 2, &w));
  check(nc_def_grp(file, "more", &group));
  check(nc_def_var(group, "hidden", NC_FLOAT, 1, dims + 2, &inner));
  check(nc_enddef(file));
  const double times[2] = {6, 12}, lat[3] = {60, 50, 40};
  const short along_x[4] = {0, 2, 4, 6};
  short numbers[2 * kY * kX];
  for (int i = 0; i < 2 * kY * kX; ++i) numbers[i] = static_cast<short>(i / 12 * 100 + i % 12);
  numbers[5] = NC_FILL_SHORT;
  const std::size_t zero[4] = {0, 0, 0, 0}, all[4] = {2, 1, kY, kX};
  check(nc_put_vara_double(file, t, zero, all, times));
  check(nc_put_var_double(file, y, lat));
  check(nc_put_var_short(file, x, along_x));
  check(nc_put_vara_short(file, v, zero, all, numbers));
  check(nc_close(file));
}

TEST(Netcdf, ReadsAxesAndStepsAndReportsOmittedVariables) {
  test::TemporaryFolder folder;
  write_axes(folder / "a.nc");
  const AnyField first = test::read(folder / "a.nc"), second = test::read(folder / "a.nc", {}, 1);
  EXPECT_EQ(second.times.size(), 2u);
  const auto at = [&](const AnyField& field, double x, double lat) {
    // A 2D field has a thickness.
    const Vec3 middle = field.get()->mapping().world_from_index(Vec3(0.0, 0.0, 0.5));
    const ScalarSample sample = test::sample_at(field, {x, lat, middle.z});
    return sample.inside ? sample.value : -1.0;
  };
  EXPECT_DOUBLE_EQ(at(second, 101, 60), 101);
  EXPECT_DOUBLE_EQ(at(second, 103, 40), 111);
  EXPECT_DOUBLE_EQ(at(first, 103, 60), 3);
  EXPECT_EQ(at(first, 101, 50), -1) << "a hole";
  EXPECT_FALSE(test::has_note(first, "resampled")) << "falling latitudes of even steps are an image";
  EXPECT_TRUE(test::has_note(first, "w (lat)"));
  EXPECT_TRUE(test::has_note(first, "1 variables in groups"));
}

TEST(Netcdf, AxesFollowTheCoordinateVariables) {
  // v = x + 10 y + 100 z at x = 0, 1, 2, 3; y = 0, 1, 2 (or 0, 1, 4); z = 0, 1, in any order of dimensions.
  struct Stated {
    const char* what;
    std::array<std::array<std::string, 3>, 3> axes;  ///< for x, y, z: name, attribute and value of the attribute
    bool noted = false;
  };
  const Stated cases[] = {
      {"axis", {{{"a", "axis", "X"}, {"b", "axis", "Y"}, {"c", "axis", "Z"}}}},
      {"units", {{{"a", "units", "degrees_east"}, {"b", "units", "degreesN"}, {"c", "units", "hPa"}}}},
      {"standard_name", {{{"a", "standard_name", "longitude"}, {"b", "standard_name", "grid_latitude"}, {"c", "standard_name", "depth"}}}},
      {"positive", {{{"a", "axis", "x"}, {"b", "units", "degree_north"}, {"c", "positive", "down"}}}},
      {"two of three", {{{"a", "axis", "X"}, {"b", "axis", "Y"}, {"c", "units", "m"}}}},
      {"names", {{{"lon", "units", "m"}, {"y", "units", "m"}, {"level", "units", "m"}}}, true},
      {"against the names", {{{"z", "axis", "X"}, {"x", "axis", "Y"}, {"y", "axis", "Z"}}}},
  };
  test::TemporaryFolder folder;
  const std::size_t sizes[3] = {4, 3, 2};
  for (const Stated& c : cases)
    for (const std::array<std::size_t, 3>& order : {std::array<std::size_t, 3>{2, 1, 0}, {0, 1, 2}, {1, 2, 0}, {0, 2, 1}})
      for (const double last_y : {2.0, 4.0}) {
        if (&c != cases && (order[0] != 0 || order[1] != 1 || last_y > 2)) continue;  // all orders for the first case only
        const double up = c.axes[2][2] == "down" ? -1 : 1;                            // sign of z, which points upwards
        const std::string path = folder / "a.nc", what = fmt::format("{} {} {}", c.what, fmt::join(order, " "), last_y);
        int file = 0, ids[3] = {0, 0, 0}, dims[4] = {0, 0, 0, 0}, v = 0, t = 0, coordinates[3] = {0, 0, 0};
        check(nc_create(path.c_str(), NC_CLOBBER | NC_NETCDF4, &file));
        check(nc_def_dim(file, "t", 2, &dims[0]));
        for (std::size_t d = 0; d < 3; ++d) check(nc_def_dim(file, c.axes[order[d]][0].c_str(), sizes[order[d]], &ids[order[d]]));
        for (std::size_t d = 0; d < 3; ++d) dims[d + 1] = ids[order[d]];
        check(nc_def_var(file, "t", NC_DOUBLE, 1, dims, &t));
        text(file, t, "units", "Hours since 2000-01-01");
        for (std::size_t a = 0; a < 3; ++a) {
          check(nc_def_var(file, c.axes[a][0].c_str(), NC_DOUBLE, 1, &ids[a], &coordinates[a]));
          const char* words = c.axes[a][2].c_str();
          if (a == 1)
            check(nc_put_att_string(file, coordinates[a], c.axes[a][1].c_str(), 1, &words));
          else
            text(file, coordinates[a], c.axes[a][1].c_str(), words);
        }
        check(nc_def_var(file, "v", NC_FLOAT, 4, dims, &v));
        check(nc_enddef(file));
        const double times[2] = {0, 6}, along[3][4] = {{0, 1, 2, 3}, {0, 1, last_y, 0}, {0, 1, 0, 0}};
        check(nc_put_var_double(file, t, times));
        for (std::size_t a = 0; a < 3; ++a) check(nc_put_var_double(file, coordinates[a], along[a]));
        std::vector<float> numbers;
        std::size_t at[3];
        for (int step = 0; step < 2; ++step)
          for (at[0] = 0; at[0] < sizes[order[0]]; ++at[0])
            for (at[1] = 0; at[1] < sizes[order[1]]; ++at[1])
              for (at[2] = 0; at[2] < sizes[order[2]]; ++at[2]) {
                double value = 1000 * step;
                for (std::size_t d = 0; d < 3; ++d) value += std::pow(10, order[d]) * along[order[d]][at[d]];
                numbers.push_back(static_cast<float>(value));
              }
        check(nc_put_var_float(file, v, numbers.data()));
        check(nc_close(file));
        const AnyField field = test::read(path, {}, 1);
        for (const Vec3& p : {Vec3(0.5, 0.5, 0.25), Vec3(2.5, 1.5, 0.75), Vec3(3, 0, 0)})
          EXPECT_NEAR(test::sample_at(field, {p.x, p.y, up * p.z}).value, 1000 + p.x + 10 * p.y + 100 * p.z, 1e-2) << what;
        const bool moved = order[0] != 2 || order[1] != 1;
        EXPECT_EQ(bool(test::has_note(field, "follow the names of the dimensions")), c.noted && moved) << what;
        EXPECT_EQ(field.time_unit, "Hours since 2000-01-01") << what;
      }
}

TEST(Netcdf, DamagedFilesAreOneErrorLine) {
  set_memory_limit(std::uint64_t{256} << 20);
  test::TemporaryFolder folder;
  const std::string path = folder / "a.nc";
  for (const int format : {kNetcdf3, kNetcdf4}) {
    write(path, {"", format, NC_SHORT, {}, {{"valid_range", NC_SHORT, {0, 20}}, {"scale_factor", NC_FLOAT, {2}}}});
    const std::string sound = test::read_file(path);
    for (test::FuzzInputs inputs(12, static_cast<std::uint64_t>(format) + 1); inputs.next();) {
      std::string bytes = sound;
      for (std::size_t n = 1 + inputs.random.below(6); n > 0; --n)
        bytes[inputs.random.below(std::min<std::size_t>(bytes.size(), 2048))] = static_cast<char>(inputs.random.next());
      if (inputs.random.below(5) == 0) bytes.resize(inputs.random.below(bytes.size()));
      test::write_file(path, bytes);
      if (const std::string message = test::error_of(path); message != "loaded") {
        EXPECT_TRUE(test::has(message, path));
        EXPECT_EQ(message.find_first_of("\r\n\x1b"), std::string::npos) << message;
        EXPECT_LT(message.size(), 800u) << message;
      }
    }
  }
  set_memory_limit(std::nullopt);
}

}  // namespace catena::field::netcdf_test
