// SPDX-License-Identifier: MIT
#include "engine/app/render/video_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>
#include <vector>

#include "engine/base/system_failure.h"

namespace catena::app {
namespace {

struct Kind {
  const char* name;
  std::vector<std::string> arguments;  ///< codec and pixel format
  bool even;                           ///< requires an even width and height
};

// RGB to YUV by the matrix that the tags name
constexpr const char* kToYuv = "scale=out_color_matrix=bt709:out_range=tv,format=";
const std::vector<std::string> kTags{"-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv"};

Kind kind_of(const std::string& name, bool alpha) {
  Kind kind{nullptr, {}, false};
  if (name == "mp4") {
    kind = {"mp4", {"-vf", std::string(kToYuv) + "yuv420p", "-c:v", "libx264", "-crf", "18", "-movflags", "+faststart"}, true};
  } else if (name == "webm") {
    kind = {
        "webm", {"-vf", std::string(kToYuv) + (alpha ? "yuva420p" : "yuv420p"), "-c:v", "libvpx-vp9", "-crf", "20", "-b:v", "0"}, false};
    kind.arguments.insert(kind.arguments.end(), {"-row-mt", "1", "-deadline", "good", "-cpu-used", "4"});
  } else {
    return {"gif", {"-filter_complex", "split[a][b];[a]palettegen=stats_mode=full[p];[b][p]paletteuse=dither=sierra2_4a"}, false};
  }
  kind.arguments.insert(kind.arguments.end(), kTags.begin(), kTags.end());
  return kind;
}

std::optional<std::string> find_ffmpeg() {
  const char* path = std::getenv("PATH");
  const std::string folders = path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin";
  for (std::size_t at = 0; at <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', at), folders.size());
    const std::string file = (end > at ? folders.substr(at, end - at) : std::string(".")) + "/ffmpeg";
    if (::access(file.c_str(), X_OK) == 0) return file;
    at = end + 1;
  }
  return std::nullopt;
}

std::string last_line(std::FILE* file) {
  std::string text;
  std::rewind(file);
  char buffer[4096];
  for (std::size_t n = 0; (n = std::fread(buffer, 1, sizeof buffer, file)) > 0;) text.append(buffer, n);
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' ')) text.pop_back();
  const auto start = text.find_last_of("\r\n");
  return start == std::string::npos ? text : text.substr(start + 1);
}

Error cannot(const std::string& path, const char* what, int code) { return system_error(fmt::format("{}: cannot {}", path, what), code); }

}  // namespace

std::optional<std::string> video_kind(const std::string& path) {
  for (const char* kind : {"mp4", "webm", "gif"})
    if (path.ends_with(std::string(".") + kind)) return kind;
  return std::nullopt;
}

bool supports_alpha(const std::string& path) { return path.ends_with(".webm"); }

Outcome check_video(const std::string& path, const VideoFormat& format) {
  if (!find_ffmpeg())
    return Error{path +
                 ": a video needs the program ffmpeg, which is not on PATH; install it (apt-get install ffmpeg), or write numbered images "
                 "(-o x_%03d.png)"};
  const Kind kind = kind_of(*video_kind(path), format.alpha);
  if (kind.even && (format.width % 2 != 0 || format.height % 2 != 0))
    return Error{fmt::format("{}: an .mp4 needs an even width and height; --size {}x{} was expected instead of {}x{}", path,
                             format.width + format.width % 2, format.height + format.height % 2, format.width, format.height)};
  return Done{};
}

Result<VideoWriter> VideoWriter::open(const std::string& path, const VideoFormat& format) {
  CATENA_CHECK(check_video(path, format));
  const std::string program = find_ffmpeg().value_or("ffmpeg");
  CATENA_TRY(TemporaryFile part, TemporaryFile::create(path));
  VideoWriter self(path, std::move(part));
  self.messages_ = std::tmpfile();
  if (self.messages_ == nullptr) return cannot(path, "open a temporary file", errno);
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return cannot(path, "open a pipe", errno);
  self.pipe_ = ends[1];

  // build the command line
  const Kind kind = kind_of(*video_kind(path), format.alpha);
  std::vector<std::string> words{program,
                                 "-hide_banner",
                                 "-loglevel",
                                 "error",
                                 "-nostdin",
                                 "-y",
                                 "-f",
                                 "rawvideo",
                                 "-pixel_format",
                                 format.alpha ? "rgba" : "rgb24",
                                 "-video_size",
                                 fmt::format("{}x{}", format.width, format.height),
                                 "-framerate",
                                 fmt::format("{}", format.fps),
                                 "-i",
                                 "pipe:0",
                                 "-an"};
  words.insert(words.end(), kind.arguments.begin(), kind.arguments.end());
  words.insert(words.end(), {"-f", kind.name, "file:" + self.part_.name()});
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  // a process group of its own: Ctrl-C is meant for this process, not for the encoder
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, fileno(self.messages_), STDERR_FILENO);
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  const int code = posix_spawn(&self.child_, program.c_str(), &actions, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  ::close(ends[0]);
  if (code != 0) {
    self.child_ = -1;
    return cannot(path, "start ffmpeg", code);
  }
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, &self.saved_action_);
  self.ignores_sigpipe_ = true;
  return self;
}

VideoWriter::VideoWriter(VideoWriter&& other) noexcept
    : path_(std::move(other.path_)),
      part_(std::move(other.part_)),
      child_(std::exchange(other.child_, -1)),
      pipe_(std::exchange(other.pipe_, -1)),
      messages_(std::exchange(other.messages_, nullptr)),
      ignores_sigpipe_(std::exchange(other.ignores_sigpipe_, false)),
      saved_action_(other.saved_action_) {}

VideoWriter::~VideoWriter() {
  if (child_ > 0) ::kill(child_, SIGKILL);
  if (pipe_ >= 0) ::close(pipe_);
  if (child_ > 0) {
    while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  if (messages_ != nullptr) std::fclose(messages_);
  if (ignores_sigpipe_) sigaction(SIGPIPE, &saved_action_, nullptr);
}

Outcome VideoWriter::write_rows(std::span<const std::uint8_t> values) {
  for (std::size_t at = 0; at < values.size();) {
    const ssize_t written = ::write(pipe_, values.data() + at, values.size() - at);
    if (written > 0) at += static_cast<std::size_t>(written);
    if (written >= 0 || errno == EINTR) continue;
    const int code = errno;
    CATENA_CHECK(close_pipe());
    return cannot(path_, "write to ffmpeg", code);
  }
  return Done{};
}

Outcome VideoWriter::close_pipe() {
  ::close(std::exchange(pipe_, -1));
  int status = 0;
  while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return Done{};
  const std::string line = last_line(messages_);
  const std::string how =
      WIFSIGNALED(status) ? fmt::format("was ended by signal {}", WTERMSIG(status)) : fmt::format("failed (exit {})", WEXITSTATUS(status));
  return Error{fmt::format("{}: ffmpeg {}{}{}", path_, how, line.empty() ? "" : ": ", line)};
}

Outcome VideoWriter::finish() { return close_pipe(); }

Outcome VideoWriter::commit() { return part_.commit(); }

}  // namespace catena::app
