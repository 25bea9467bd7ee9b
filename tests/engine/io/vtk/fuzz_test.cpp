// SPDX-License-Identifier: MIT
/// Damaged files of the formats that catena-read-vtk and catena-read read: the result is a grid or mesh that can be sampled, or a one-line
/// error, within the limits of time and memory. Two of three changed bytes are in the first 2 kB, which contain the headers.
#include <gtest/gtest.h>

#include "engine/base/memory_limit.h"
#include "engine/io/mesh/load_mesh.h"
#include "tests/engine/field/field_helpers.h"
#include "tests/engine/io/vtk/files.h"
#include "tests/fuzz/mutate.h"
#include "tests/fuzz/mutate_bytes.h"

namespace catena::field::vtk_fuzz_test {

namespace files = test::vtk_files;

struct Seed {
  const char* name;
  std::string bytes;
  bool mesh = false;
};

/// A DICOM file with functional groups and a vector of offsets, which covers both ways to place frames.
std::string dicom_frames() {
  using files::Dicom;
  Dicom d = files::dicom_image({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}).decimals(files::kFrames, {2}, "IS").decimals(0x3004000c, {0, 3});
  const Dicom rescale = Dicom().sequence(0x00289145, {Dicom().decimals(files::kSlope, {2}).decimals(files::kIntercept, {-1})});
  return d.sequence(0x52009229, {rescale}).sequence(0x52009230, {Dicom().decimals(0x00200012, {1}, "IS"), rescale}).file();
}

std::vector<Seed> seeds() {
  const auto linear = [](const Vec3& p) { return p.x + 2 * p.y; };
  const auto counted = [](int k, int j, int i) { return 100 * k + 10 * j + i; };
  return {{"a.vti", files::vti("1 0 0 0 1 0 0 0 1", linear)},
          {"b.vti", files::vti_hidden()},
          {"a.vtk", files::legacy_vectors()},
          {"a.vts", files::vts_ring(3, 5, 3, linear)},
          {"a.vtu", files::vtu_mixed(linear)},
          {"a.npy", files::npy({2, 3, 4}, "<f8", false, counted)},
          {"a.nrrd", files::nrrd("left-posterior-superior")},
          {"a.mha", files::mha("RAI")},
          {"a.dcm", dicom_frames()},
          {"a.ply", files::ply(), true},
          {"b.ply", files::ply_doubles("binary_big_endian", "binary_big_endian"), true},
          {"b.nrrd", files::nrrd_vectors("las", "measurement frame: (0,1,0) (0,0,1) (1,0,0)\n")},
          {"a.gii", files::gifti(), true},
          {"a.vtp", files::vtp(), true}};
}

class VtkFuzz : public test::FilesTest {
 protected:
  VtkFuzz() { set_memory_limit(std::uint64_t{256} << 20); }
  ~VtkFuzz() override { set_memory_limit(std::nullopt); }

  void expect_one_line(const std::string& message, const std::string& path) {
    EXPECT_TRUE(test::has(message, path));
    EXPECT_EQ(message.find_first_of("\r\n\x1b"), std::string::npos) << message;
    EXPECT_EQ(message.find("0x"), std::string::npos) << "an address: " << message;
    EXPECT_LT(message.size(), 800u) << message;
  }
  /// Loads the bytes; true if they are a valid file.
  bool check(const Seed& seed, const std::string& bytes) {
    const std::string path = file(seed.name, bytes);
    if (seed.mesh) {
      const auto mesh = mesh::load_mesh(path);
      if (!mesh) expect_one_line(mesh.error().message, path);
      return static_cast<bool>(mesh);
    }
    const std::string name = seed.name;
    const auto field = load(test::request_for(path, name == "a.vtk" ? "wind" : name == "a.vtu" ? "v" : ""));
    if (!field) {
      expect_one_line(field.error().message, path);
      return false;
    }
    const Field& loaded = *field->get();
    Cursor cursor;
    for (int i = 0; i < 8; ++i) {
      if (field->scalar)
        field->scalar->sample(loaded.corner(i), cursor);
      else
        field->vector->sample(loaded.corner(i), cursor);
    }
    return true;
  }
};

TEST_F(VtkFuzz, DamagedFilesEndInOneLine) {
  for (const Seed& seed : seeds()) {
    EXPECT_TRUE(check(seed, seed.bytes)) << seed.name;
    std::uint64_t loaded = 0, all = 0;
    for (catena::test::FuzzInputs inputs(12, std::hash<std::string>{}(seed.name)); inputs.next(); ++all) {
      std::string bytes = seed.bytes;
      const std::size_t changes = 1 + inputs.random.below(6);
      for (std::size_t c = 0; c < changes; ++c) {
        const std::size_t at = inputs.random.below(3) == 0 ? inputs.random.below(bytes.size())
                                                           : inputs.random.below(std::min<std::size_t>(bytes.size(), 2048));
        bytes[at] = static_cast<char>(inputs.random.below(4) == 0 ? inputs.random.next() : '0' + inputs.random.below(10));
      }
      if (inputs.random.below(5) == 0) bytes.resize(inputs.random.below(bytes.size()));
      loaded += check(seed, bytes) ? 1 : 0;
    }
    RecordProperty(seed.name, std::to_string(loaded) + " of " + std::to_string(all));
  }
}

}  // namespace catena::field::vtk_fuzz_test
