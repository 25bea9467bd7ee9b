// SPDX-License-Identifier: MIT
/// Video through ffmpeg: the decoded frames, and runs without ffmpeg, with a failing ffmpeg, and with Ctrl-C.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "engine/app/render/video_writer.h"
#include "render/image/image.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace video_test {

using namespace catena;

constexpr const char* kScene = R"({"fields": {"s": {"analytic": "torus", "resolution": 24}}, "isosurfaces": [{"field": "s", "level": 0.5}],
  "camera": {"position": [4, -5, 3], "target": [0, 0, 0], "up": [1, 0, 0], "fovy_deg": 40}})";

/// Sets PATH for the lifetime of the object.
class Path {
 public:
  explicit Path(const std::string& value) : before_(std::getenv("PATH")) { setenv("PATH", value.c_str(), 1); }
  ~Path() { setenv("PATH", before_.c_str(), 1); }

 private:
  std::string before_;
};

/// Writes a fake program called ffmpeg into the folder.
void make_ffmpeg(const std::string& folder, const std::string& script) {
  test::write_file(folder + "/ffmpeg", "#!/bin/sh\n" + script + "\n");
  ASSERT_EQ(chmod((folder + "/ffmpeg").c_str(), 0700), 0);
}

bool has_ffmpeg() { return static_cast<bool>(app::check_video("a.mp4", {2, 2, 25, false})); }

int files_in(const std::string& folder) { return int(std::distance(std::filesystem::directory_iterator(folder), {})); }

/// Frame `k` of a video as ffmpeg decodes it.
render::Image8 frame_of(const std::string& video, int k, const std::string& folder) {
  const std::string png = folder + "/frame.png";
  const auto run = test::run_program("/usr/bin/env", {"ffmpeg", "-v", "error", "-y", "-i", video, "-vf",
                                                      "select=eq(n\\," + std::to_string(k) + ")", "-frames:v", "1", png});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  auto picture = render::read_png(png);
  EXPECT_TRUE(picture);
  return picture ? std::move(*picture) : render::Image8();
}

double rms(const render::Image8& a, const render::Image8& b) {
  EXPECT_EQ(a.rgba.size(), b.rgba.size());
  double sum = 0;
  for (std::size_t i = 0; i < std::min(a.rgba.size(), b.rgba.size()); ++i) sum += std::pow(double(a.rgba[i]) - b.rgba[i], 2);
  return std::sqrt(sum / double(a.rgba.size()));
}

TEST(Video, FramesEqualTheImagesOfTheSequence) {
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not on PATH";
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", kScene);
  const std::vector<std::string> turn{"--size", "128x96", "--frames", "4", "--orbit", "180"};
  const auto render = [&](const char* name) {
    std::vector<std::string> arguments{"render", folder / "s.json", "-o", folder / name};
    arguments.insert(arguments.end(), turn.begin(), turn.end());
    const auto run = test::run_catena(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
  };
  render("p_%d.png");
  for (const char* name : {"v.mp4", "v.webm", "v.gif"}) {
    render(name);
    for (const int k : {0, 2}) {
      const auto truth = render::read_png(folder / ("p_" + std::to_string(k) + ".png"));
      ASSERT_TRUE(truth);
      const render::Image8 seen = frame_of(folder / name, k, folder.path());
      const render::Image8 other = *render::read_png(folder / ("p_" + std::to_string(3 - k) + ".png"));
      // Differences are caused by chroma at half resolution, quantization and the 256 colors of a .gif.
      EXPECT_LE(rms(seen, *truth), 6) << name << " " << k;
      EXPECT_GT(rms(seen, other), 8) << name << " " << k;
    }
    const auto info =
        test::run_program("/usr/bin/env", {"ffprobe", "-v", "error", "-count_frames", "-show_entries",
                                           "stream=width,height,nb_read_frames,r_frame_rate", "-of", "csv=p=0", folder / name});
    EXPECT_EQ(info.out, "128,96,25/1,4\n") << name;
  }
}

TEST(Video, WebmKeepsATransparentBackground) {
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not on PATH";
  const test::TemporaryFolder folder;
  std::string scene = kScene;
  scene.insert(scene.rfind('}'), ", \"background\": \"transparent\"");
  test::write_file(folder / "s.json", scene);
  const auto run = test::run_catena({"render", folder / "s.json", "-o", folder / "v.webm", "--size", "65x49", "--frames", "2"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto decoded = test::run_program("/usr/bin/env", {"ffmpeg", "-v", "error", "-c:v", "libvpx-vp9", "-i", folder / "v.webm",
                                                          "-frames:v", "1", "-pix_fmt", "rgba", folder / "f.png"});
  ASSERT_EQ(decoded.exit_code, 0) << decoded.err;
  const auto picture = render::read_png(folder / "f.png");
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->width, 65u);
  EXPECT_LE(picture->pixel(1, 1)[3], 2);
  int solid = 0;
  for (std::size_t i = 3; i < picture->rgba.size(); i += 4) solid += picture->rgba[i] > 250;
  EXPECT_GT(solid, 100);
}

TEST(Video, WithoutFfmpegTheErrorNamesThePackage) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", kScene);
  const Path path(folder.path());
  const auto run = test::run_catena({"render", folder / "s.json", "-o", folder / "v.mp4", "--frames", "2", "--size", "16x16"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_NE(run.err.find("apt-get install ffmpeg"), std::string::npos) << run.err;
  EXPECT_EQ(files_in(folder.path()), 1);
}

TEST(Video, AFailureOfFfmpegIsReportedWithItsLastLine) {
  const test::TemporaryFolder folder, tools;
  test::write_file(folder / "s.json", kScene);
  // Failures at the start, in the middle and at the end.
  for (const char* script : {"echo first >&2; echo no such codec >&2; exit 3", "head -c 500 >/dev/null; echo no such codec >&2; exit 3",
                             "cat >/dev/null; echo no such codec >&2; exit 3"}) {
    make_ffmpeg(tools.path(), script);
    const Path path(tools.path() + ":" + std::getenv("PATH"));
    const auto run = test::run_catena({"render", folder / "s.json", "-o", folder / "v.mp4", "--frames", "3", "--size", "64x64"});
    EXPECT_EQ(run.exit_code, 2) << script;
    EXPECT_NE(run.err.find("v.mp4: ffmpeg failed (exit 3): no such codec"), std::string::npos) << run.err;
    EXPECT_EQ(files_in(folder.path()), 1) << script;
  }
}

TEST(Video, CtrlCLeavesNoPartialFile) {
  const test::TemporaryFolder folder, tools;
  test::write_file(folder / "s.json", kScene);
  make_ffmpeg(tools.path(), "exec cat >/dev/null");
  const Path path(tools.path() + ":" + std::getenv("PATH"));
  for (const char* name : {"v.mp4", "big.png"}) {
    const bool video = std::string(name) == "v.mp4";
    const std::string out = folder / name, scene = folder / "s.json";
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      const int nothing = open("/dev/null", O_WRONLY);
      dup2(nothing, 1);
      dup2(nothing, 2);
      execl(test::program_path().c_str(), test::program_path().c_str(), "render", scene.c_str(), "-o", out.c_str(), "--frames",
            video ? "90000" : "1", "--size", video ? "64x64" : "16000x16000", nullptr);
      _exit(127);
    }
    // Waits until the program writes.
    int status = 0;
    while (files_in(folder.path()) < 2) {
      ASSERT_EQ(waitpid(child, &status, WNOHANG), 0) << "it ended before it wrote";
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    ASSERT_EQ(kill(child, SIGINT), 0);
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1) << name << " " << status;
    EXPECT_EQ(files_in(folder.path()), 1) << name;
  }
}

TEST(Video, OddSizesOfMp4AndUnknownFormatsAreRefused) {
  const test::TemporaryFolder tools;
  make_ffmpeg(tools.path(), "exit 0");
  const Path path(tools.path());
  const auto odd = app::check_video("v.mp4", {641, 480, 25, false});
  ASSERT_FALSE(odd);
  EXPECT_NE(odd.error().message.find("--size 642x480"), std::string::npos) << odd.error().message;
  EXPECT_TRUE(app::check_video("v.webm", {641, 481, 25, false}));
  EXPECT_TRUE(app::check_video("v.gif", {641, 481, 25, false}));
  EXPECT_EQ(app::video_kind("a/b.mp4"), "mp4");
  EXPECT_EQ(app::video_kind("a/b.png"), std::nullopt);
  EXPECT_EQ(app::video_kind("mp4"), std::nullopt);
}

}  // namespace video_test
