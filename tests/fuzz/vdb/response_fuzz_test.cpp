// SPDX-License-Identifier: MIT
/// Responses of the reader's process are untrusted, because it may be compromised. They are forged here, as a whole and in parts.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <new>

#include "engine/base/helper_process.h"
#include "engine/field/nanovdb/nano_nodes.h"
#include "engine/field/nanovdb/nano_statistics.h"
#include "engine/io/client.h"
#include "engine/io/volume/load_field.h"
#include "tests/fuzz/mutate_bytes.h"
#include "tests/fuzz/vdb/vdb_corpus.h"
#include "tests/support/support.h"

namespace catena::field::response_fuzz_test {

using catena::test::Random;
using catena::test::TemporaryFolder;

/// The response of an honest reader to a file.
std::string honest_answer(const std::string& path, const std::string& grid) {
  ReadRequest request;
  request.load_request.path = path;
  request.load_request.grid = grid;
  request.memory_bytes = std::uint64_t{512} << 20;
  request.cpu_s = 30;
  const std::string text = encode(request);
  const FileDescriptor file(::memfd_create("answer", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  MessageHeader head;
  head.offset = sizeof head;
  head.bytes = text.size();
  EXPECT_EQ(::pwrite(file.get(), &head, sizeof head, 0), static_cast<ssize_t>(sizeof head));
  EXPECT_EQ(::pwrite(file.get(), text.data(), text.size(), sizeof head), static_cast<ssize_t>(text.size()));
  const int given[] = {file.get()};
  auto reader = HelperProcess::start(helper_path("catena-read"), given);
  EXPECT_TRUE(reader && reader->wait(60).code == 0);
  std::string answer(static_cast<std::size_t>(::lseek(file.get(), 0, SEEK_END)), '\0');
  EXPECT_EQ(::pread(file.get(), answer.data(), answer.size(), 0), static_cast<ssize_t>(answer.size()));
  return answer;
}

MessageHeader head_of(const std::string& answer) {
  MessageHeader head;
  std::memcpy(&head, answer.data(), sizeof head);
  return head;
}

ReadResponse reply_of(const std::string& answer) {
  const MessageHeader head = head_of(answer);
  const auto reply = decode_response({reinterpret_cast<const std::byte*>(answer.data()) + head.offset, head.bytes});
  EXPECT_TRUE(reply);
  return reply ? *reply : ReadResponse{};
}

/// Responses come from the malicious reader, with short timeouts.
class ResponseFuzz : public testing::Test {
 protected:
  ResponseFuzz() { reader_settings() = {helper_path("test_forger"), 5, 3}; }
  ~ResponseFuzz() override { reader_settings() = {}; }

  Result<AnyField> load_forged(const std::string& answer) {
    const std::string path = folder_ / "forged.vdb";
    catena::test::write_file(path, answer);
    LoadRequest request;
    request.path = path;
    return load(request);
  }
  std::string error_of(const std::string& answer) {
    const auto field = load_forged(answer);
    EXPECT_FALSE(field);
    return field ? std::string() : field.error().message;
  }
  std::string honest(const std::string& specimen, const std::string& grid) {
    for (const auto& s : catena::test::vdb_corpus())
      if (s.name == specimen) catena::test::write_file(folder_ / "honest.vdb", s.bytes);
    return honest_answer(folder_ / "honest.vdb", grid);
  }
  TemporaryFolder folder_;
};

TEST_F(ResponseFuzz, AnUnresponsiveReaderIsAnErrorInOneLine) {
  EXPECT_NE(error_of("HANG").find("took more than"), std::string::npos);
  EXPECT_NE(error_of("SPIN").find("took more than"), std::string::npos);
  EXPECT_NE(error_of("EXIT").find("ended with code 7"), std::string::npos);
  EXPECT_NE(error_of("ABORT").find("crashed"), std::string::npos);
  // the request is still in place of the response
  EXPECT_NE(error_of("KEEP").find("cannot be sealed"), std::string::npos);
  EXPECT_NE(error_of(std::string(1, 'x')).find("head"), std::string::npos);
  EXPECT_NE(error_of(std::string(5000, 'x')).find("head"), std::string::npos);
  reader_settings().program = "/nowhere/catena-read";
  EXPECT_NE(error_of("x").find("cannot be started"), std::string::npos);
}

TEST_F(ResponseFuzz, ForgedResponsesThroughTheWholePath) {
  const std::string answer = honest("masked", "density");
  const auto sound = load_forged(answer);
  ASSERT_TRUE(sound) << sound.error().message;
  const MessageHeader head = head_of(answer);
  catena::test::FuzzInputs inputs(60, 11);
  Random& random = inputs.random;
  int loaded = 0, refused = 0;
  while (inputs.next() && !HasFailure()) {
    // the header, the reply after the buffers, or any part
    const std::size_t part = random.below(3), first = part == 1 ? head.offset : 0, last = part == 0 ? sizeof head : answer.size();
    const auto field = load_forged(catena::test::mutate_bytes(answer, random, 3, first, last));
    ++(field ? loaded : refused);
    if (!field) {
      EXPECT_EQ(field.error().message.find('\n'), std::string::npos);
      continue;
    }
    const Box box = field->get()->index_box();
    Cursor cursor;
    for (const Vec3& at : {box.lo, box.hi, 0.5 * (box.lo + box.hi)}) catena::test::sample_at_index(*field, at, cursor);
  }
  if (inputs.is_long_run()) fmt::print("{} answers: {} loaded, {} refused\n", inputs.count(), loaded, refused);
  EXPECT_GT(refused, 0);
  EXPECT_GT(loaded, 0);
}

/// The buffer in memory of its exact size, so that the address sanitizer detects reads past the end.
class Exact {
 public:
  explicit Exact(const std::string& bytes) : size_(bytes.size()), data_(static_cast<std::byte*>(::operator new(size_, kAlignment))) {
    std::memcpy(data_, bytes.data(), size_);
  }
  Exact(const Exact&) = delete;
  ~Exact() { ::operator delete(data_, kAlignment); }
  std::span<const std::byte> bytes() const { return {data_, size_}; }

 private:
  static constexpr std::align_val_t kAlignment{32};
  std::size_t size_;
  std::byte* data_;
};

/// Reads everything in a buffer as the program does.
template <class T>
void walk(const nanovdb::NanoGrid<T>& grid, Random& random) {
  const ActiveBox box = compute_active_box(grid);
  if (box.empty() || !is_within_index_limits(box)) return;
  if constexpr (std::is_same_v<T, nanovdb::ValueMask>) {
    EXPECT_GT(count_voxels(grid), 0u);
    const auto modest = [](double bytes) { return check_memory_available("it", bytes, std::uint64_t{64} << 20); };
    (void)erode_mask(grid, box, &grid, &NanoMemory::reserve, modest);
  } else {
    EXPECT_GT(compute_stats(grid, nullptr).stats.active_voxels, 0u);
  }
  const auto accessor = grid.getAccessor();
  for (int i = 0; i < 50; ++i) {
    nanovdb::Coord c;
    for (int a = 0; a < 3; ++a)
      c[a] = static_cast<int>(box.lo[a] + static_cast<std::int64_t>(random.below(static_cast<std::size_t>(box.voxels(a)))));
    (void)accessor.getValue(c);
    (void)accessor.isActive(c);
  }
}

template <class T>
void fuzz_buffer(const std::string& answer, const BufferRange& piece, std::uint64_t seed) {
  const std::string whole = answer.substr(piece.offset, piece.bytes);
  ASSERT_TRUE(validate_nano<T>(Exact(whole).bytes()));
  catena::test::FuzzInputs inputs(1500, seed);
  Random& random = inputs.random;
  std::uint64_t passed = 0;
  // the first and last parts of the buffer, with headers, nodes and tables, or anywhere
  const std::size_t edge = std::min<std::size_t>(whole.size(), 2048);
  while (inputs.next() && !testing::Test::HasFailure()) {
    const std::size_t part = random.below(3), first = part == 1 ? whole.size() - edge : 0, last = part == 0 ? edge : whole.size();
    const Exact buffer(catena::test::mutate_bytes(whole, random, 2, first, last));
    if (!validate_nano<T>(buffer.bytes())) continue;
    ++passed;
    walk(*reinterpret_cast<const nanovdb::NanoGrid<T>*>(buffer.bytes().data()), random);
  }
  if (inputs.is_long_run()) fmt::print("{} buffers: {} passed the check\n", inputs.count(), passed);
  EXPECT_GT(passed, 0u);
  EXPECT_LT(passed, inputs.count());
}

TEST_F(ResponseFuzz, BuffersOfNumbersAndTiles) {
  for (const auto& [specimen, seed] : {std::pair{"blosc", 21u}, {"tiles", 22u}}) {
    const std::string answer = honest(specimen, "density");
    fuzz_buffer<float>(answer, reply_of(answer).values, seed);
  }
}

TEST_F(ResponseFuzz, BuffersOfVectors) {
  const std::string answer = honest("vectors", "velocity");
  fuzz_buffer<nanovdb::Vec3f>(answer, reply_of(answer).values, 23);
}

TEST_F(ResponseFuzz, BuffersOfMasks) {
  const std::string answer = honest("masked", "density");
  fuzz_buffer<nanovdb::ValueMask>(answer, reply_of(answer).valid_voxels, 24);
  fuzz_buffer<nanovdb::ValueMask>(answer, reply_of(answer).valid_cells, 25);
}

}  // namespace catena::field::response_fuzz_test
