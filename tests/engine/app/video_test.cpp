// SPDX-License-Identifier: MIT
/// Video through ffmpeg: the decoded frames, and runs without ffmpeg, with a failing ffmpeg, and with Ctrl-C.
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "engine/app/render/video_writer.h"
#include "render/image/image.h"
#include "tests/engine/app/environment_variable.h"
#include "tests/engine/app/program_in_folder.h"

namespace video_test {

using namespace catena;

constexpr const char* kScene = R"({"fields": {"s": {"analytic": "torus", "resolution": 24}}, "isosurfaces": [{"field": "s", "level": 0.5}],
  "camera": {"position": [4, -5, 3], "target": [0, 0, 0], "up": [1, 0, 0], "fovy_deg": 40}})";

/// Writes a fake program called ffmpeg into the folder.
void make_ffmpeg(const std::string& folder, const std::string& script) {
  test::write_file(folder + "/ffmpeg", "#!/bin/sh\n" + script + "\n");
  ASSERT_EQ(chmod((folder + "/ffmpeg").c_str(), 0700), 0);
}

bool has_ffmpeg() { return static_cast<bool>(app::check_video("a.mp4", {2, 2, 25, false})); }

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

class Video : public test::ProgramInFolder {
 protected:
  Video() { write("s.json", kScene); }
  render::Image8 picture(const std::string& name) const {
    auto read = render::read_png(folder_ / name);
    EXPECT_TRUE(read) << name;
    return read ? std::move(*read) : render::Image8();
  }
};

TEST_F(Video, FramesEqualTheImagesOfTheSequence) {
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not on PATH";
  const auto render = [&](const std::string& name) { succeed("render {s.json} -o {" + name + "} --size 128x96 --frames 4 --orbit 180"); };
  render("p_%d.png");
  for (const char* name : {"v.mp4", "v.webm", "v.gif"}) {
    render(name);
    for (const int k : {0, 2}) {
      const render::Image8 seen = frame_of(folder_ / name, k, folder_.path());
      const render::Image8 truth = picture("p_" + std::to_string(k) + ".png"), other = picture("p_" + std::to_string(3 - k) + ".png");
      // Differences are caused by chroma at half resolution, quantization and the 256 colors of a .gif.
      EXPECT_LE(rms(seen, truth), 6) << name << " " << k;
      EXPECT_GT(rms(seen, other), 8) << name << " " << k;
    }
    const auto info =
        test::run_program("/usr/bin/env", {"ffprobe", "-v", "error", "-count_frames", "-show_entries",
                                           "stream=width,height,nb_read_frames,r_frame_rate", "-of", "csv=p=0", folder_ / name});
    EXPECT_EQ(info.out, "128,96,25/1,4\n") << name;
  }
}

TEST_F(Video, WebmKeepsATransparentBackground) {
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not on PATH";
  std::string scene = kScene;
  scene.insert(scene.rfind('}'), ", \"background\": \"transparent\"");
  write("s.json", scene);
  succeed("render {s.json} -o {v.webm} --size 65x49 --frames 2");
  const auto decoded = test::run_program("/usr/bin/env", {"ffmpeg", "-v", "error", "-c:v", "libvpx-vp9", "-i", folder_ / "v.webm",
                                                          "-frames:v", "1", "-pix_fmt", "rgba", folder_ / "f.png"});
  ASSERT_EQ(decoded.exit_code, 0) << decoded.err;
  const render::Image8 frame = picture("f.png");
  ASSERT_EQ(frame.width, 65u);
  EXPECT_LE(frame.pixel(1, 1)[3], 2);
  int solid = 0;
  for (std::size_t i = 3; i < frame.rgba.size(); i += 4) solid += frame.rgba[i] > 250;
  EXPECT_GT(solid, 100);
}

TEST_F(Video, WithoutFfmpegTheErrorNamesThePackage) {
  const test::EnvironmentVariable path("PATH", folder_.path());
  expect_refused("render {s.json} -o {v.mp4} --frames 2 --size 16x16", {"apt-get install ffmpeg"});
}

TEST_F(Video, AFailureOfFfmpegIsReportedWithItsLastLine) {
  const test::TemporaryFolder tools;
  // Failures at the start, in the middle and at the end.
  for (const char* script : {"echo first >&2; echo no such codec >&2; exit 3", "head -c 500 >/dev/null; echo no such codec >&2; exit 3",
                             "cat >/dev/null; echo no such codec >&2; exit 3"}) {
    make_ffmpeg(tools.path(), script);
    const test::EnvironmentVariable path("PATH", tools.path() + ":" + std::getenv("PATH"));
    expect_refused("render {s.json} -o {v.mp4} --frames 3 --size 64x64", {"v.mp4: ffmpeg failed (exit 3): no such codec"});
  }
}

TEST_F(Video, CtrlCLeavesNoPartialFile) {
  const test::TemporaryFolder tools;
  make_ffmpeg(tools.path(), "exec cat >/dev/null");
  const test::EnvironmentVariable path("PATH", tools.path() + ":" + std::getenv("PATH"));
  for (const char* name : {"v.mp4", "big.png"}) {
    const bool video = std::string(name) == "v.mp4";
    const std::string out = folder_ / name, scene = folder_ / "s.json";
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
    while (files() < 2) {
      ASSERT_EQ(waitpid(child, &status, WNOHANG), 0) << "it ended before it wrote";
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    ASSERT_EQ(kill(child, SIGINT), 0);
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1) << name << " " << status;
    EXPECT_EQ(files(), 1) << name;
  }
}

TEST_F(Video, OddSizesOfMp4AndUnknownFormatsAreRefused) {
  const test::TemporaryFolder tools;
  make_ffmpeg(tools.path(), "exit 0");
  const test::EnvironmentVariable path("PATH", tools.path());
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
