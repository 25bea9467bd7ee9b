// SPDX-License-Identifier: MIT
/// Mutated stores: a field or an error of one line. tests/stores/fuzz_stores.py has more, and further layouts.
#include "engine/base/memory_limit.h"
#include "engine/io/volume/load_field.h"
#include "tests/engine/io/chunks/store_files.h"
#include "tests/fuzz/mutate_bytes.h"

namespace catena::field::stores_fuzz_test {

using catena::stores_test::Volume;

void expect_a_field_or_a_sentence(const std::string& path) {
  set_memory_limit(100'000'000);
  LoadRequest request;
  request.path = path;
  const auto loaded = load(request);
  set_memory_limit(std::nullopt);
  if (loaded) return;
  EXPECT_NE(loaded.error().message.find(path), std::string::npos) << loaded.error().message;
  EXPECT_EQ(loaded.error().message.find('\n'), std::string::npos) << loaded.error().message;
  EXPECT_FALSE(loaded.error().system_failure) << loaded.error().message;
}

TEST(StoresFuzz, Zarr) {
  test::TemporaryFolder folder;
  test::FuzzInputs inputs(40, 1);
  const Volume small{20, 20, 20};
  while (inputs.next()) {
    const std::string path = folder / fmt::format("{}.zarr", inputs.count());
    const char* const codecs[] = {"blosc", "zlib", "lz4", "zstd"};
    catena::stores_test::write_zarr(path, small, {codecs[inputs.count() % 4], "<u2", ".", false, 16});
    const std::string file = path + (inputs.random.below(2) == 0 ? "/.zarray" : "/0.0.0"), text = test::read_file(file);
    test::write_file(file, file.ends_with("y") ? test::mutate(text, inputs.random) : test::mutate_bytes(text, inputs.random));
    expect_a_field_or_a_sentence(path);
  }
}

TEST(StoresFuzz, TiffAndHdf5) {
  test::TemporaryFolder folder;
  test::FuzzInputs inputs(80, 2);
  catena::stores_test::write_tiff(folder / "a.tif", {30, 20, 3}, true);
  catena::stores_test::write_hdf5(folder / "a.h5", {40, 20, 20}, "a", true);
  const std::string tiff = test::read_file(folder / "a.tif"), hdf5 = test::read_file(folder / "a.h5");
  while (inputs.next()) {
    const bool is_tiff = inputs.count() % 2 == 0;
    const std::string path = folder / fmt::format("{}.{}", inputs.count(), is_tiff ? "tif" : "h5");
    test::write_file(path, test::mutate_bytes(is_tiff ? tiff : hdf5, inputs.random, 6));
    expect_a_field_or_a_sentence(path);
  }
}

}  // namespace catena::field::stores_fuzz_test
