// SPDX-License-Identifier: MIT
/// Damaged NIfTI files, plain and compressed, and raw volumes of any stated shape: a grid that can be sampled, or an error in one line,
/// within the memory limit.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "engine/base/memory_limit.h"
#include "engine/io/volume/load_field.h"
#include "tests/fuzz/mutate_bytes.h"
#include "tests/support/nifti_file.h"
#include "tests/support/support.h"

namespace catena::field::volume_fuzz_test {

class VolumeFuzz : public testing::Test {
 protected:
  VolumeFuzz() { set_memory_limit(std::uint64_t{64} << 20); }
  ~VolumeFuzz() override { set_memory_limit(std::nullopt); }

  /// Loads a file and samples it in its domain; true if it was loaded.
  bool check(const LoadRequest& request) {
    const auto field = load(request);
    if (!field) {
      test::expect_error_line(field.error().message, "", {}, 600, request.path.c_str());
      EXPECT_EQ(field.error().message.find('\x1b'), std::string::npos) << field.error().message;
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
    test::NiftiFile file({5, 4, 3}, 16, 32);
    file.put(112, 0.5f);
    file.put(252, std::int16_t{1});
    file.put(254, std::int16_t{1});
    file.put(280, std::array<float, 12>{2, 0, 0, -4, 0, 2, 0, 1, 0, 0, 2, 7});
    for (int i = 0; i < 60; ++i) file.append(static_cast<float>(i) * 0.1f);
    return file.bytes();
  }
  test::TemporaryFolder folder_;
};

TEST_F(VolumeFuzz, NiftiMutations) {
  const std::string whole = nifti();
  ASSERT_TRUE(check("sound.nii", whole));
  // most changes are in the header
  test::fuzz(3000, 31, [&](test::Random& random, std::uint64_t) {
    const std::size_t end = random.below(4) == 0 ? whole.size() : 352;
    return check("mutated.nii", test::mutate_bytes(whole, random, 3, 0, end));
  });
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
  while (inputs.next() && !HasFailure()) loaded += check("mutated.nii.gz", test::mutate_bytes(whole, inputs.random, 3, 0, whole.size()));
  EXPECT_LT(loaded, inputs.count());
}

TEST_F(VolumeFuzz, RawFilesOfAnyStatedShape) {
  const std::string path = folder_ / "a.raw";
  test::write_file(path, std::string(4000, '\x3f'));
  constexpr const char* kTypes[] = {"float32", "float64", "uint8", "int16", "uint32", "float32x3", "uint8x3", "text"};
  const auto length = [](test::Random& random) {
    const int lengths[] = {0, 1, -1, 10, 5, 2000, 1 << 20, 1 << 30, 2147483647};
    return random.below(3) == 0 ? lengths[random.below(std::size(lengths))] : static_cast<int>(random.below(12));
  };
  test::fuzz(1500, 41, [&](test::Random& random, std::uint64_t) {
    RawLayout layout;
    layout.shape = random.below(4) == 0 ? Index3{10, 10, 10} : Index3{length(random), length(random), length(random)};
    layout.type = kTypes[random.below(std::size(kTypes))];
    const double numbers[] = {1, 0.5, -1, 0, 1e300, 1e-300, std::nan(""), 1e38};
    if (random.below(2) == 0) layout.spacing[static_cast<int>(random.below(3))] = numbers[random.below(std::size(numbers))];
    if (random.below(2) == 0) layout.origin[static_cast<int>(random.below(3))] = numbers[random.below(std::size(numbers))];
    LoadRequest request;
    request.path = path;
    request.raw = layout;
    return check(request);
  });
}

}  // namespace catena::field::volume_fuzz_test
