#include "engine/field/vdb_reader.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>

#include "engine/base/helper_process.h"
#include "engine/base/text.h"
#include "engine/field/formats.h"

namespace catena::field {
namespace {

constexpr std::size_t kBuffer = 1 << 20;

Error cannot_write(const std::string& path, const std::string& why, bool machine = false) {
  return Error{fmt::format("{}: cannot be written ({})", path, one_line(why)), machine};
}

}  // namespace

VdbStream::VdbStream(std::string path, OutputFile file, HelperProcess writer, Descriptor line)
    : path_(std::move(path)), file_(std::move(file)), writer_(std::move(writer)), line_(std::move(line)) {
  buffer_.reserve(kBuffer);
}

Result<VdbStream> VdbStream::open(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, ignored))
    return Error{fmt::format("{}: the folder {} does not exist", path, folder.string())};
  if (fs::is_directory(path, ignored)) return Error{fmt::format("{}: this is a folder, expected the name of a file to write", path)};
  CATENA_TRY(OutputFile file, OutputFile::open(path));
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return cannot_write(path, std::strerror(errno), true);
  Descriptor near(ends[0]), far(ends[1]);
  const int given[] = {far.get(), ::fileno(file.stream())};
  auto writer = HelperProcess::start(helper_path("catena-write"), given);
  if (!writer) return cannot_write(path, writer.error().message, writer.error().machine);
  return VdbStream(path, std::move(file), std::move(*writer), std::move(near));
}

void VdbStream::put(const void* data, std::size_t bytes) {
  if (buffer_.size() + bytes > kBuffer) flush();
  buffer_.append(static_cast<const char*>(data), bytes);
}

void VdbStream::flush() {
  for (std::size_t at = 0; at < buffer_.size() && !broken_;) {
    const ssize_t n = ::send(line_.get(), buffer_.data() + at, buffer_.size() - at, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    broken_ = n <= 0;
    at += n > 0 ? static_cast<std::size_t>(n) : 0;
  }
  buffer_.clear();
}

void VdbStream::begin_grid(StreamKind kind, const std::string& name, const Mapping& mapping, const float* background, bool merge) {
  StreamHead head;
  head.kind = kind;
  head.name_bytes = static_cast<std::uint32_t>(name.size());
  head.merge = merge ? 1 : 0;
  value_count_ = kind == StreamKind::scalar ? 1 : kind == StreamKind::vector ? 3 : 0;
  value_bytes_ = value_count_ * sizeof(float);
  if (value_bytes_ > 0) std::memcpy(head.background, background, value_bytes_);
  for (int a = 0; a < 3; ++a)
    for (int c = 0; c < 3; ++c) head.world_from_index[a][c] = mapping.world_from_index_linear[a][c];
  for (int c = 0; c < 3; ++c) head.world_from_index[3][c] = mapping.origin[c];
  put(&head, sizeof head);
  put(name.data(), name.size());
}

void VdbStream::leaf(const nanovdb::Coord& origin, const nanovdb::Mask<3>& active, const void* values) {
  StreamRecord record;
  record.type = StreamRecord::leaf;
  for (int a = 0; a < 3; ++a) record.origin[a] = origin[a];
  put(&record, sizeof record);
  put(&active, sizeof active);
  if (value_bytes_ > 0) put(values, 512 * value_bytes_);
}

void VdbStream::tile(const nanovdb::Coord& origin, std::int32_t edge, const float* value, bool active) {
  StreamRecord record;
  record.type = edge == 8 ? StreamRecord::tile_8 : edge == 128 ? StreamRecord::tile_128 : StreamRecord::tile_4096;
  record.active = active ? 1 : 0;
  for (int a = 0; a < 3; ++a) record.origin[a] = origin[a];
  if (value_bytes_ > 0) std::memcpy(record.value, value, value_bytes_);
  put(&record, sizeof record);
}

void VdbStream::end_grid() {
  const StreamRecord record;
  put(&record, sizeof record);
}

Outcome VdbStream::finish() {
  flush();
  ::shutdown(line_.get(), SHUT_WR);
  // the answer
  std::string answer;
  char piece[512];
  constexpr std::size_t kLongest = 2000;
  for (;;) {
    const ssize_t n = ::recv(line_.get(), piece, sizeof piece, 0);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    if (answer.size() < kLongest) answer.append(piece, static_cast<std::size_t>(n));
  }
  constexpr double kLongestWait_s = 60;  // it has closed its end
  const HelperEnd end = writer_.wait(kLongestWait_s);
  if (!answer.empty()) return cannot_write(path_, answer);
  if (end.how != HelperEnd::How::exited || end.code != 0) return cannot_write(path_, "the program catena-write broke down");
  if (broken_) return cannot_write(path_, "the program catena-write ended too early");
  return file_.commit();
}

namespace {

bool write_at(int fd, std::uint64_t at, const void* data, std::size_t bytes) {
  const char* from = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t n = ::pwrite(fd, from, bytes, static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    from += n;
    at += static_cast<std::uint64_t>(n);
    bytes -= static_cast<std::size_t>(n);
  }
  return true;
}

Result<Descriptor> file_with_request(const ReadRequest& request) {
  const std::string text = encode(request);
  Descriptor file(::memfd_create("catena-read", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!file && errno == EMFILE) return Error{request.what.path + ": cannot be read: " + too_few_descriptors(), true};
  ExchangeHead head;
  head.offset = sizeof head;
  head.bytes = text.size();
  if (!file || !write_at(file.get(), 0, &head, sizeof head) || !write_at(file.get(), head.offset, text.data(), text.size()))
    return Error{fmt::format("{}: no memory to read it into ({})", request.what.path, std::strerror(errno)), true};
  return file;
}

/// What became of a reader that did not answer.
Error end_of(const ReadRequest& request, const HelperEnd& end) {
  const std::string& path = request.what.path;
  const bool out_of_time = end.how == HelperEnd::How::too_long || (end.how == HelperEnd::How::killed && end.code == SIGXCPU);
  if (out_of_time)
    return Error{fmt::format("{}: reading it took more than {} s of processor time: the file is damaged, expected a sound .vdb file", path,
                             request.cpu_s)};
  if (end.how == HelperEnd::How::killed && end.code == SIGKILL)
    return Error{fmt::format("{}: its reader was killed (by hand, or as memory ran out), expected it to end by itself", path)};
  if (end.how == HelperEnd::How::killed && (end.code == SIGINT || end.code == SIGTERM || end.code == SIGHUP))
    return Error{fmt::format("{}: reading it was interrupted, expected it to end by itself", path)};
  if (end.how == HelperEnd::How::killed)
    return Error{
        fmt::format("{}: the file is damaged (its reader broke down: {}), expected a sound .vdb file", path, ::strsignal(end.code))};
  return Error{fmt::format("{}: the file is damaged (its reader gave up with code {}), expected a sound .vdb file", path, end.code)};
}

Error nonsense(const std::string& path, std::string_view what) {
  return Error{fmt::format("{}: the file is damaged (of what its reader made of it, {}), expected a sound .vdb file", path, what)};
}

/// The reader has ended: nobody can change the file any more once it is sealed.
Result<ReaderAnswer> take_answer(const std::string& path, const Descriptor& file) {
  struct stat status {};
  if (::fcntl(file.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL) != 0 || ::fstat(file.get(), &status) != 0)
    return nonsense(path, "the memory cannot be sealed");
  const auto bytes = static_cast<std::uint64_t>(status.st_size);
  ExchangeHead head;
  if (bytes < sizeof head) return nonsense(path, "the head is missing");
  void* start = ::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, file.get(), 0);
  if (start == MAP_FAILED) return Error{fmt::format("{}: no memory to map it ({})", path, std::strerror(errno))};
  ReaderAnswer answer;
  answer.memory = NanoMemory::mapped(start, bytes, true);
  std::memcpy(&head, start, sizeof head);
  if (head.magic != kExchangeMagic || head.version != kExchangeVersion || head.from_reader != 1 || head.offset > bytes ||
      head.bytes > bytes - head.offset)
    return nonsense(path, "the head is not one");
  auto reply = decode_reply({answer.memory.data() + head.offset, head.bytes});
  if (!reply) return nonsense(path, reply.error().message);
  answer.reply = std::move(*reply);
  return answer;
}

// ---- the words on units, kept for as long as the file stays as it is ----

struct Known {
  std::filesystem::file_time_type at;
  std::uintmax_t bytes = 0;
  ReadReply words;
};
std::mutex known_mutex;
std::map<std::string, Known> known_words;

bool look_at(const std::string& path, Known& file) {
  std::error_code code;
  file.at = std::filesystem::last_write_time(path, code);
  if (!code) file.bytes = std::filesystem::file_size(path, code);
  return !code;
}

void keep_words(const std::string& path, const Known& before, const ReadReply& reply) {
  Known entry = before;
  entry.words.units = reply.units;
  entry.words.unit_length = reply.unit_length;
  entry.words.words = reply.words;
  const std::scoped_lock lock(known_mutex);
  constexpr std::size_t kMost = 256;
  if (known_words.size() >= kMost) known_words.clear();
  known_words[path] = std::move(entry);
}

}  // namespace

ReaderSettings& reader_settings() {
  static ReaderSettings settings;
  return settings;
}

std::uint64_t reading_time_s(std::uint64_t file_bytes) {
  constexpr std::uint64_t kLeast = 10, kBytesPerSecond = 2'000'000;
  return kLeast + file_bytes / kBytesPerSecond;
}

Result<ReaderAnswer> ask_reader(ReadMode mode, const LoadRequest& what) {
  CATENA_TRY(const std::uint64_t size, readable_file(what.path));
  const ReaderSettings& settings = reader_settings();
  ReadRequest request{mode, what, allowed_memory(), settings.cpu_s > 0 ? settings.cpu_s : reading_time_s(size)};
  Known before;
  const bool can_keep = look_at(what.path, before);
  // the reader does its work
  CATENA_TRY(Descriptor file, file_with_request(request));
  const int given[] = {file.get()};
  const std::string program = settings.program.empty() ? helper_path("catena-read") : settings.program;
  auto reader = HelperProcess::start(program, given);
  if (!reader) return Error{what.path + ": cannot be read: " + reader.error().message, reader.error().machine};
  // a reader that sleeps uses no processor time: disks may be slow, but not without end
  constexpr double kLeastWait = 60, kWaits = 10;
  const double wall_s = settings.wall_s > 0 ? settings.wall_s : std::max(kLeastWait, kWaits * static_cast<double>(request.cpu_s));
  const HelperEnd end = reader->wait(wall_s);
  if (end.how != HelperEnd::How::exited || end.code != 0) return end_of(request, end);
  // what it wrote
  CATENA_TRY(ReaderAnswer answer, take_answer(what.path, file));
  constexpr std::size_t kLongestError = 2000;
  if (!answer.reply.error.empty()) return Error{one_line(answer.reply.error.substr(0, kLongestError))};
  if (can_keep) keep_words(what.path, before, answer.reply);
  return answer;
}

std::optional<ReadReply> unit_words_of(const std::string& path) {
  Known now;
  if (!look_at(path, now)) return std::nullopt;
  {
    const std::scoped_lock lock(known_mutex);
    const auto found = known_words.find(path);
    if (found != known_words.end() && found->second.at == now.at && found->second.bytes == now.bytes) return found->second.words;
  }
  LoadRequest request;
  request.path = path;
  auto answer = ask_reader(ReadMode::units, request);
  if (!answer) return std::nullopt;
  return std::move(answer->reply);
}

}  // namespace catena::field
