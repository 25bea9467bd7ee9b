// SPDX-License-Identifier: MIT
/// Damaged NIfTI files, plain and compressed, and raw volumes of any stated shape: a grid that can be sampled, or an error in one line,
/// within the memory limit.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

#include "engine/base/memory_limit.h"
#include "engine/io/volume/load_field.h"
#include "tests/fuzz/mutate_bytes.h"
#include "tests/support/support.h"

namespace catena::field {
namespace volume_fuzz_test {

class VolumeFuzz : public testing::Test {
 protected:
  VolumeFuzz() { set_memory_limit(std::uint64_t{64} << 20); }
  ~VolumeFuzz() override { set_memory_limit(std::nullopt); }

  /// Loads a file and samples it in its domain; true if it was loaded.
  bool check(const LoadRequest& request) {
    const auto field = load(request);
    if (!field) {
      const std::string& message = field.error().message;
      EXPECT_NE(message.find(request.path), std::string::npos) << message;
      EXPECT_EQ(message.find_first_of("\r\n\x1b"), std::string::npos) << message;
      EXPECT_LT(message.size(), 600u) << message;
      return false;
    }
    const Field& loaded = *field->get();
    EXPECT_TRUE(std::isfinite(loaded.domain_length()) && loaded.domain_length() >= 0);
    const Box& box = loaded.index_box();
    Cursor cursor;
    for (const Vec3& at : {box.lo, box.hi, 0.5 * (box.lo + box.hi)}) {
      const Vec3 world = loaded.mapping().world_from_index(at);
      EXPECT_TRUE(is_finite(world));
      if (field->scalar)
        field->scalar->sample(world, cursor);
      else
        field->vector->sample(world, cursor);
    }
    return true;
  }
  bool check(const std::string& name, const std::string& bytes) {
    test::write_file(folder_ / name, bytes);
    LoadRequest request;
    request.path = folder_ / name;
    return check(request);
  }

  /// A NIfTI-1 file of 5 x 4 x 3 numbers with both transforms.
  static std::string nifti() {
    std::string bytes(352, '\0');
    const auto put = [&]<class T>(std::size_t at, T value) { std::memcpy(bytes.data() + at, &value, sizeof value); };
    put(0, std::int32_t{348});
    const std::int16_t dimensions[] = {3, 5, 4, 3, 1, 1, 1, 1};
    for (std::size_t d = 0; d < 8; ++d) put(40 + 2 * d, dimensions[d]);
    put(70, std::int16_t{16});  // float
    put(72, std::int16_t{32});
    for (std::size_t d = 0; d < 8; ++d) put(76 + 4 * d, 1.f);
    put(108, 352.f);
    put(112, 0.5f);
    put(252, std::int16_t{1});
    put(254, std::int16_t{1});
    const float rows[12] = {2, 0, 0, -4, 0, 2, 0, 1, 0, 0, 2, 7};
    std::memcpy(bytes.data() + 280, rows, sizeof rows);
    std::memcpy(bytes.data() + 344, "n+1", 4);
    for (int i = 0; i < 60; ++i) {
      const float value = static_cast<float>(i) * 0.1f;
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    return bytes;
  }
  test::TemporaryFolder folder_;
};

TEST_F(VolumeFuzz, NiftiMutations) {
  const std::string whole = nifti();
  ASSERT_TRUE(check("sound.nii", whole));
  test::FuzzInputs inputs(3000, 31);
  std::uint64_t loaded = 0;
  while (inputs.next() && !HasFailure()) {
    // most changes are in the header
    const std::size_t end = inputs.random.below(4) == 0 ? whole.size() : 352;
    loaded += check("mutated.nii", test::mutate_bytes(whole, inputs.random, 3, 0, end)) ? 1 : 0;
  }
  EXPECT_GT(loaded, 0u);
  EXPECT_LT(loaded, inputs.count());
}

TEST_F(VolumeFuzz, EveryByteFlipOfANiftiHeader) {
  const std::string whole = nifti();
  for (std::size_t at = 0; at < 352 && !HasFailure(); ++at)
    for (const int turn : {0x01, 0x80, 0xff}) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ turn);
      check("turned.nii", bytes);
    }
}

TEST_F(VolumeFuzz, CompressedMutations) {
  test::write_file(folder_ / "seed.nii", nifti());
  ASSERT_EQ(std::system(("gzip -n -k '" + (folder_ / "seed.nii") + "'").c_str()), 0);
  const std::string whole = test::read_file(folder_ / "seed.nii.gz");
  ASSERT_TRUE(check("sound.nii.gz", whole));
  test::FuzzInputs inputs(1500, 37);
  std::uint64_t loaded = 0;
  while (inputs.next() && !HasFailure())
    loaded += check("mutated.nii.gz", test::mutate_bytes(whole, inputs.random, 3, 0, whole.size())) ? 1 : 0;
  EXPECT_LT(loaded, inputs.count());
}

TEST_F(VolumeFuzz, RawFilesOfAnyStatedShape) {
  const std::string path = folder_ / "a.raw";
  test::write_file(path, std::string(4000, '\x3f'));
  constexpr const char* kTypes[] = {"float32", "float64", "uint8", "int16", "uint32", "float32x3", "uint8x3", "text"};
  test::FuzzInputs inputs(1500, 41);
  test::Random& random = inputs.random;
  std::uint64_t loaded = 0;
  const auto length = [&] {
    const int lengths[] = {0, 1, -1, 10, 5, 2000, 1 << 20, 1 << 30, 2147483647};
    return random.below(3) == 0 ? lengths[random.below(std::size(lengths))] : static_cast<int>(random.below(12));
  };
  while (inputs.next() && !HasFailure()) {
    RawLayout layout;
    layout.shape = random.below(4) == 0 ? Index3{10, 10, 10} : Index3{length(), length(), length()};
    layout.type = kTypes[random.below(std::size(kTypes))];
    const double numbers[] = {1, 0.5, -1, 0, 1e300, 1e-300, std::nan(""), 1e38};
    if (random.below(2) == 0) layout.spacing[static_cast<int>(random.below(3))] = numbers[random.below(std::size(numbers))];
    if (random.below(2) == 0) layout.origin[static_cast<int>(random.below(3))] = numbers[random.below(std::size(numbers))];
    LoadRequest request;
    request.path = path;
    request.raw = layout;
    loaded += check(request) ? 1 : 0;
  }
  EXPECT_GT(loaded, 0u);
  EXPECT_LT(loaded, inputs.count());
}

}  // namespace volume_fuzz_test
}  // namespace catena::field
