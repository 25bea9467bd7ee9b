// SPDX-License-Identifier: MIT
/// Damaged .vdb files through the whole path: reader process, response, grid, a few samples. Longer runs:
///   CATENA_FUZZ_INPUTS=100000 build/release/test_fuzz_vdb --gtest_filter='VdbFuzz.Mutations'
/// prints the numbers of the results. CATENA_FUZZ_KEEP=FOLDER saves the files, for runs with another build.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>

#include "engine/base/clock.h"
#include "engine/base/memory_limit.h"
#include "engine/io/volume/load_field.h"
#include "tests/fuzz/mutate_bytes.h"
#include "tests/fuzz/vdb/vdb_corpus.h"
#include "tests/support/support.h"

namespace catena::field::vdb_fuzz_test {

using catena::test::Random;
using catena::test::TemporaryFolder;
using catena::test::VdbFile;

/// Counts of the results, by their error message.
struct Tally {
  std::map<std::string, int> ends;
  std::string last;  ///< last error message
  double longest_s = 0;
  int inputs = 0;

  void count(const std::string& message) {
    last = message;
    for (const char* words : {"took more than", "crashed", "ended with code", "was killed", "invalid response", "of memory", "truncated",
                              "not a .vdb", "has no", "there is no", "transform"})
      if (message.find(words) != std::string::npos) {
        ++ends[words];
        return;
      }
    ++ends["other sentences"];
  }
  void print() const {
    fmt::print("{} inputs, the longest took {:.2f} s\n", inputs, longest_s);
    for (const auto& [words, count] : ends) fmt::print("  {:7} {}\n", count, words);
  }
};

void expect_sentence(const std::string& message, const std::string& path, Tally& tally) {
  tally.count(message);
  EXPECT_TRUE(message.starts_with(path + ": ")) << message;
  EXPECT_LT(message.size(), 3000u);
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

void use(const AnyField& field, Random& random) {
  const auto between = [&](double lo, double hi) { return lo + (hi - lo) * static_cast<double>(random.below(1001)) / 1000; };
  Cursor cursor;
  const Box box = field.get()->index_box();
  for (int i = 0; i < 20; ++i) {
    const Vec3 index(between(box.lo.x, box.hi.x), between(box.lo.y, box.hi.y), between(box.lo.z, box.hi.z));
    catena::test::sample_at_index(field, index, cursor);
  }
  EXPECT_TRUE(std::isfinite(field.get()->domain_length()) && field.get()->domain_length() >= 0) << "0: of one voxel";
}

/// Runs one input through `load` and `describe`, or only through `load`.
void feed(const std::string& path, const std::string& bytes, bool describe_too, Random& random, Tally& tally) {
  catena::test::write_file(path, bytes);
  LoadRequest request;
  request.path = path;
  if (bytes.find("velocity") == std::string::npos) request.grid = "density";
  const std::int64_t start = now_ns();
  const auto field = load(request);
  if (field) {
    ++tally.ends["loaded"];
    use(*field, random);
  } else {
    expect_sentence(field.error().message, path, tally);
  }
  if (describe_too)
    if (const auto grids = describe_grids(path); !grids) expect_sentence(grids.error().message, path, tally);
  tally.longest_s = std::max(tally.longest_s, 1e-9 * static_cast<double>(now_ns() - start));
  ++tally.inputs;
}

/// Memory limit of these small files.
class VdbFuzz : public testing::Test {
 protected:
  VdbFuzz() { set_memory_limit(std::uint64_t{512} << 20); }
  ~VdbFuzz() override { set_memory_limit(std::nullopt); }
  TemporaryFolder folder_;
  Tally tally_;
};

TEST_F(VdbFuzz, TheCorpusIsValid) {
  Random random{1};
  for (const VdbFile& specimen : catena::test::vdb_corpus()) {
    feed(folder_ / "sound.vdb", specimen.bytes, true, random, tally_);
    EXPECT_EQ(tally_.ends["loaded"], tally_.inputs) << specimen.name << ": " << tally_.last;
  }
}

TEST_F(VdbFuzz, OneChangedByteOfACompressedFile) {
  Random random{2};
  const std::uint64_t stride = catena::test::FuzzInputs::number("CATENA_FUZZ_STRIDE", 397);
  for (const VdbFile& specimen : catena::test::vdb_corpus()) {
    if (specimen.name != "blosc" && specimen.name != "half-blosc") continue;
    for (std::size_t at = 0; at < specimen.bytes.size() && !HasFailure(); at += stride) {
      std::string bytes = specimen.bytes;
      bytes[at] = static_cast<char>(bytes[at] ^ (at % 2 == 0 ? 0xff : 0x80));
      feed(folder_ / "byte.vdb", bytes, false, random, tally_);
    }
  }
  if (stride == 1) tally_.print();
  EXPECT_GT(tally_.ends.size(), 1u);
}

TEST_F(VdbFuzz, Mutations) {
  catena::test::FuzzInputs inputs(100, 1);
  Random& random = inputs.random;
  const char* keep = std::getenv("CATENA_FUZZ_KEEP");
  const std::vector<VdbFile> corpus = catena::test::vdb_corpus();
  while (inputs.next() && !HasFailure()) {
    const VdbFile& specimen = corpus[random.below(corpus.size())];
    // half of the changes are in the header and the tree's upper levels, which contain sizes
    const std::size_t end = random.below(2) == 0 ? std::min<std::size_t>(specimen.bytes.size(), 1200) : specimen.bytes.size();
    const std::string bytes = catena::test::mutate_bytes(specimen.bytes, random, 3, 0, end);
    const std::string path = keep ? fmt::format("{}/{}.vdb", keep, inputs.count()) : folder_ / "mutated.vdb";
    feed(path, bytes, inputs.count() % 4 == 0, random, tally_);
  }
  if (inputs.is_long_run()) tally_.print();
  EXPECT_GT(tally_.ends["loaded"], 0);
  EXPECT_LT(tally_.ends["loaded"], tally_.inputs);
}

/// Sets the number of the root's tiles: without a bound OpenVDB would read billions of them past the file's end.
TEST_F(VdbFuzz, AFalseNumberOfTilesIsAnErrorInOneLine) {
  Random random{3};
  const std::string whole = catena::test::vdb_bytes({catena::test::make_bump_grid<openvdb::FloatGrid>("density", 3)}, 0);
  // one buffer, the background (0), the number of tiles (0) and of children (4)
  const std::string counts("\1\0\0\0\0\0\0\0\0\0\0\0\4\0\0\0", 16);
  const std::size_t at = whole.find(counts);
  ASSERT_NE(at, std::string::npos);
  for (const std::size_t place : {at + 8, at + 12})
    for (const std::uint32_t count : {0x7fffffffu, 0xffffffffu, 0x10000000u, 100000u}) {
      std::string bytes = whole;
      std::memcpy(bytes.data() + place, &count, sizeof count);
      feed(folder_ / "tiles.vdb", bytes, true, random, tally_);
    }
  EXPECT_EQ(tally_.ends["loaded"], 0);
  EXPECT_EQ(tally_.ends["took more than"], 0);
}

}  // namespace catena::field::vdb_fuzz_test
