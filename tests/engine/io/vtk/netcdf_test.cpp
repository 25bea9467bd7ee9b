// SPDX-License-Identifier: MIT
/// NetCDF files written by the NetCDF library: holes and values as the attributes of each variable define them.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <netcdf.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "engine/base/memory_limit.h"
#include "engine/io/volume/load_field.h"
#include "tests/fuzz/mutate.h"
#include "tests/fuzz/mutate_bytes.h"
#include "tests/support/support.h"

namespace catena::field {
namespace netcdf_test {

constexpr int kZ = 2, kY = 3, kX = 4, kAll = kZ * kY * kX;

void check(int code) { ASSERT_EQ(code, NC_NOERR) << nc_strerror(code); }

/// A variable "v" over (z, y, x) with the values 0, 1, 2, ... and `special` values from index 5.
struct Case {
  const char* what;
  int format;  ///< NC_CLASSIC_MODEL: NetCDF 3; NC_NETCDF4: compressed and shuffled
  nc_type type;
  std::vector<double> special;
  std::function<void(int file, int v)> attributes;
  double factor = 1, offset = 0;
  std::set<int> holes{};                         ///< indices without a value
  std::vector<std::pair<int, double>> values{};  ///< indices whose value is not factor * stored + offset
};

template <class T>
void att(int file, int v, const char* name, nc_type type, std::vector<T> numbers) {
  check(nc_put_att(file, v, name, type, numbers.size(), numbers.data()));
}
void text(int file, int v, const char* name, const std::string& words) {
  check(nc_put_att_text(file, v, name, words.size(), words.data()));
}

void write(const std::string& path, const Case& c) {
  int file = 0, dims[3] = {0, 0, 0}, v = 0;
  check(nc_create(path.c_str(), NC_CLOBBER | (c.format == NC_NETCDF4 ? NC_NETCDF4 : 0), &file));
  const int sizes[3] = {kZ, kY, kX};
  const char* names[3] = {"z", "y", "x"};
  for (int d = 0; d < 3; ++d) check(nc_def_dim(file, names[d], static_cast<std::size_t>(sizes[d]), &dims[d]));
  check(nc_def_var(file, "v", c.type, 3, dims, &v));
  if (c.format == NC_NETCDF4) check(nc_def_var_deflate(file, v, 1, 1, 5));
  c.attributes(file, v);
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

std::vector<float> read(const std::string& path, std::vector<std::string>* notes = nullptr) {
  LoadRequest request;
  request.path = path;
  const auto field = load(request);
  EXPECT_TRUE(field) << (field ? "" : field.error().message);
  std::vector<float> values(kAll, -1);
  if (!field || !field->scalar) return values;
  if (notes != nullptr) *notes = field->notes;
  field->scalar->grid()->read_block({0, 0, 0}, {kX, kY, kZ}, values);
  return values;
}

TEST(Netcdf, HolesAndValuesFollowTheAttributes) {
  using B = signed char;
  using S = short;
  const std::vector<Case> cases = {
      {"packed fill",
       NC_CLASSIC_MODEL,
       NC_SHORT,
       {-32768, -32767},
       [](int f, int v) {
         att<S>(f, v, "_FillValue", NC_SHORT, {-32768}), att<float>(f, v, "scale_factor", NC_FLOAT, {.5F}),
             att<float>(f, v, "add_offset", NC_FLOAT, {10});
       },
       .5,
       10,
       {5}},
      {"default fill", NC_CLASSIC_MODEL, NC_SHORT, {-32767, -32768}, [](int, int) {}, 1, 0, {5}},
      {"default fill of 64 bits", NC_NETCDF4, NC_INT64, {-9e18}, [](int, int) {}, 1, 0, {5}},
      {"default fill of floats", NC_NETCDF4, NC_FLOAT, {NC_FILL_FLOAT, NAN}, [](int, int) {}, 1, 0, {5, 6}},
      {"bytes have none", NC_CLASSIC_MODEL, NC_BYTE, {-127, -128}, [](int, int) {}},
      {"missing values, a list",
       NC_NETCDF4,
       NC_INT,
       {-99, -98, -97},
       [](int f, int v) {
         att<int>(f, v, "missing_value", NC_INT, {-99, -98});
       },
       1,
       0,
       {5, 6}},
      {"missing value of another type",
       NC_CLASSIC_MODEL,
       NC_SHORT,
       {-999},
       [](int f, int v) { att<double>(f, v, "missing_value", NC_DOUBLE, {-999}); },
       1,
       0,
       {5}},
      {"missing value as text", NC_CLASSIC_MODEL, NC_FLOAT, {-999}, [](int f, int v) { text(f, v, "missing_value", "-999.0"); }, 1, 0, {5}},
      {"double rounded to float",
       NC_NETCDF4,
       NC_FLOAT,
       {1e20F, -9999.9F},
       [](int f, int v) {
         att<double>(f, v, "missing_value", NC_DOUBLE, {1e20, -9999.9});
       },
       1,
       0,
       {5, 6}},
      {"float beside doubles",
       NC_CLASSIC_MODEL,
       NC_DOUBLE,
       {-9999.9},
       [](int f, int v) { att<float>(f, v, "missing_value", NC_FLOAT, {-9999.9F}); },
       1,
       0,
       {5}},
      {"both rounded",
       NC_CLASSIC_MODEL,
       NC_DOUBLE,
       {1e20},
       [](int f, int v) { att<double>(f, v, "missing_value", NC_DOUBLE, {1e20F}); },
       1,
       0,
       {5}},
      {"unsigned bytes",
       NC_CLASSIC_MODEL,
       NC_BYTE,
       {-1, -2},
       [](int f, int v) {
         text(f, v, "_Unsigned", "true"), att<B>(f, v, "_FillValue", NC_BYTE, {-1}), att<double>(f, v, "scale_factor", NC_DOUBLE, {2});
       },
       2,
       0,
       {5},
       {{6, 508}}},
      {"unsigned range",
       NC_CLASSIC_MODEL,
       NC_BYTE,
       {-1, -56},
       [](int f, int v) {
         text(f, v, "_Unsigned", "true"), att<B>(f, v, "valid_range", NC_BYTE, {0, -56});
       },
       1,
       0,
       {5},
       {{6, 200}}},
      {"true unsigned bytes",
       NC_NETCDF4,
       NC_UBYTE,
       {255},
       [](int f, int v) { att<unsigned char>(f, v, "_FillValue", NC_UBYTE, {255}); },
       1,
       0,
       {5}},
      {"range in stored units",
       NC_CLASSIC_MODEL,
       NC_SHORT,
       {-7, 300},
       [](int f, int v) {
         att<float>(f, v, "scale_factor", NC_FLOAT, {.1F}), att<S>(f, v, "valid_range", NC_SHORT, {-5, 100});
       },
       .1F,
       0,
       {5, 6}},
      {"range in the values' units",
       NC_NETCDF4,
       NC_SHORT,
       {-7, 300},
       [](int f, int v) {
         att<float>(f, v, "scale_factor", NC_FLOAT, {.1F}), att<float>(f, v, "valid_range", NC_FLOAT, {-.5F, 10});
       },
       .1F,
       0,
       {5, 6}},
      {"least and most",
       NC_CLASSIC_MODEL,
       NC_DOUBLE,
       {-1, 1000},
       [](int f, int v) { att<double>(f, v, "valid_min", NC_DOUBLE, {0}), att<double>(f, v, "valid_max", NC_DOUBLE, {999}); },
       1,
       0,
       {5, 6}},
  };
  test::TemporaryFolder folder;
  for (const Case& c : cases) {
    const std::string path = folder / (c.format == NC_NETCDF4 ? "a.nc" : "a.cdf");
    write(path, c);
    const std::vector<float> values = read(path);
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
  std::vector<std::string> notes;
  write(folder / "n.nc", cases.back());
  read(folder / "n.nc", &notes);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("2 of 24 values are outside the valid range of the file (0 .. 999)"), std::string::npos) << notes[0];
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
  att<double>(file, x, "scale_factor", NC_DOUBLE, {.5});
  att<double>(file, x, "add_offset", NC_DOUBLE, {100});
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
  LoadRequest request;
  request.path = folder / "a.nc";
  write_axes(request.path);
  const auto first = load(request);
  request.step = 1;
  const auto second = load(request);
  ASSERT_TRUE(first && second) << first.error().message;
  EXPECT_EQ(second->times.size(), 2u);
  Cursor cursor;
  const auto at = [&](const AnyField& field, double x, double lat) {
    // A 2D field has a thickness.
    const Vec3 middle = field.get()->mapping().world_from_index(Vec3(0.0, 0.0, 0.5));
    const ScalarSample sample = field.scalar->sample({x, lat, middle.z}, cursor);
    return sample.inside ? sample.value : -1.0;
  };
  EXPECT_DOUBLE_EQ(at(*second, 101, 60), 101);
  EXPECT_DOUBLE_EQ(at(*second, 103, 40), 111);
  EXPECT_DOUBLE_EQ(at(*first, 103, 60), 3);
  EXPECT_EQ(at(*first, 101, 50), -1) << "a hole";
  const auto has = [&](const std::string& words) {
    return std::any_of(first->notes.begin(), first->notes.end(),
                       [&](const std::string& note) { return note.find(words) != std::string::npos; });
  };
  EXPECT_FALSE(has("resampled")) << "falling latitudes of even steps are an image";
  EXPECT_TRUE(has("w (lat)"));
  EXPECT_TRUE(has("1 variables in groups"));
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
        LoadRequest request;
        request.path = path;
        request.step = 1;
        const auto field = load(request);
        ASSERT_TRUE(field) << what << ": " << field.error().message;
        Cursor cursor;
        for (const Vec3& p : {Vec3(0.5, 0.5, 0.25), Vec3(2.5, 1.5, 0.75), Vec3(3, 0, 0)})
          EXPECT_NEAR(field->scalar->sample(Vec3(p.x, p.y, up * p.z), cursor).value, 1000 + p.x + 10 * p.y + 100 * p.z, 1e-2) << what;
        const bool noted = std::ranges::any_of(
            field->notes, [](const std::string& note) { return note.find("follow the names of the dimensions") != std::string::npos; });
        const bool moved = order[0] != 2 || order[1] != 1;
        EXPECT_EQ(noted, c.noted && moved) << what;
        EXPECT_EQ(field->time_unit, "Hours since 2000-01-01") << what;
      }
}

TEST(Netcdf, DamagedFilesAreOneErrorLine) {
  set_memory_limit(std::uint64_t{256} << 20);
  test::TemporaryFolder folder;
  const std::string path = folder / "a.nc";
  for (const int format : {NC_CLASSIC_MODEL, NC_NETCDF4}) {
    const auto attributes = [](int f, int v) {
      att<short>(f, v, "valid_range", NC_SHORT, {0, 20}), att<float>(f, v, "scale_factor", NC_FLOAT, {2});
    };
    write(path, {"", format, NC_SHORT, {}, attributes});
    const std::string sound = test::read_file(path);
    for (test::FuzzInputs inputs(12, static_cast<std::uint64_t>(format) + 1); inputs.next();) {
      std::string bytes = sound;
      for (std::size_t n = 1 + inputs.random.below(6); n > 0; --n)
        bytes[inputs.random.below(std::min<std::size_t>(bytes.size(), 2048))] = static_cast<char>(inputs.random.next());
      if (inputs.random.below(5) == 0) bytes.resize(inputs.random.below(bytes.size()));
      test::write_file(path, bytes);
      LoadRequest request;
      request.path = path;
      if (const auto field = load(request); !field) {
        const std::string& message = field.error().message;
        EXPECT_NE(message.find(path), std::string::npos) << message;
        EXPECT_EQ(message.find_first_of("\r\n\x1b"), std::string::npos) << message;
        EXPECT_LT(message.size(), 800u) << message;
      }
    }
  }
  set_memory_limit(std::nullopt);
}

}  // namespace netcdf_test
}  // namespace catena::field
