// SPDX-License-Identifier: MIT
// Autosave keeps unsaved edits when the window is killed, closed by a key or closed by its close button.
#include "engine/app/viewer/scene/autosave.h"

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "render/image/image.h"
#include "tests/support/drive_window.h"
#include "tests/support/support.h"

namespace catena::app {
namespace autosave_test {

namespace fs = std::filesystem;

constexpr const char* kScene = R"({
  // the flow
  "fields": {"v": {"analytic": "circle"}},
  "streamlines": [{"field": "v", "seeds": [[1, 0, 0]]}],
  "camera": {"position": [0, 0, 6], "target": [0, 0, 0], "up": [0, 1, 0]} })";

std::vector<std::string> drafts_in(const std::string& folder) {
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename().string().find(".unsaved-") != std::string::npos) found.push_back(entry.path().string());
  return found;
}

/// Sets XDG_STATE_HOME for the lifetime of the object.
class StateHome {
 public:
  explicit StateHome(const std::string& path) {
    if (const char* before = std::getenv("XDG_STATE_HOME")) before_ = before;
    ::setenv("XDG_STATE_HOME", path.c_str(), 1);
  }
  ~StateHome() {
    if (before_)
      ::setenv("XDG_STATE_HOME", before_->c_str(), 1);
    else
      ::unsetenv("XDG_STATE_HOME");
  }

 private:
  std::optional<std::string> before_;
};

TEST(Autosave, ADataFilesDraftLiesInTheStateFolderUntilItsSceneIsSaved) {
  const test::TemporaryFolder data, other, home;
  const StateHome state(home / "state");
  const std::string scene = data / "head.nii.json", unsaved = home / "state/catena/unsaved";
  test::write_file(data / "head.nii", "data");
  {
    Autosave draft;
    ASSERT_TRUE(draft.save_text(scene, "one"));
    EXPECT_EQ(std::distance(fs::directory_iterator(data.path()), fs::directory_iterator()), 1) << "the data alone";
    ASSERT_EQ(drafts_in(unsaved).size(), 1u);
  }
  EXPECT_FALSE(find_orphaned_autosave(other / "head.nii.json")) << "a file of that name elsewhere";
  const auto left = find_orphaned_autosave(scene);
  ASSERT_TRUE(left);
  EXPECT_EQ(left->text, "one");
  remove_orphaned_autosave(*left);
  EXPECT_TRUE(drafts_in(unsaved).empty());
  // A draft is written next to the scene when a scene file exists there.
  test::write_file(scene, "{}");
  Autosave draft;
  ASSERT_TRUE(draft.save_text(scene, "two"));
  EXPECT_EQ(drafts_in(data.path()).size(), 1u);
  draft.remove();
}

TEST(Autosave, IsWrittenAtomicallyAndFoundAfterItsProcessEnds) {
  const test::TemporaryFolder folder;
  const std::string scene = folder / "a.json";
  test::write_file(scene, kScene);
  {
    Autosave draft;
    ASSERT_TRUE(draft.save_text(scene, "one"));
    ASSERT_TRUE(draft.save_text(scene, "two"));
    const auto files = drafts_in(folder.path());
    ASSERT_EQ(files.size(), 1u) << "one a window, and no unfinished ones";
    EXPECT_EQ(test::read_file(files[0]), "two");
    struct stat about {};
    ASSERT_EQ(::stat(files[0].c_str(), &about), 0);
    EXPECT_EQ(about.st_mode & 0777u, 0600u);
    EXPECT_FALSE(find_orphaned_autosave(scene)) << "its program runs";
    // Another window on the same scene writes a draft of its own.
    Autosave other;
    ASSERT_TRUE(other.save_text(scene, "other"));
    EXPECT_EQ(drafts_in(folder.path()).size(), 2u);
    other.remove();
    EXPECT_EQ(drafts_in(folder.path()), files);
  }
  const auto left = find_orphaned_autosave(scene);
  ASSERT_TRUE(left);
  EXPECT_EQ(left->text, "two");
  EXPECT_FALSE(find_orphaned_autosave(folder / "b.json"));
  remove_orphaned_autosave(*left);
  EXPECT_FALSE(find_orphaned_autosave(scene));
  EXPECT_TRUE(drafts_in(folder.path()).empty());
}

TEST(Autosave, AKilledProcessLeavesItsLastText) {
  const test::TemporaryFolder folder;
  const std::string scene = folder / "a.json";
  test::write_file(scene, kScene);
  const pid_t child = ::fork();
  if (child == 0) {
    Autosave draft;
    for (int i = 0; i < 10; ++i) static_cast<void>(draft.save_text(scene, std::string(1000 * i, 'x')));
    ::kill(::getpid(), SIGKILL);
  }
  ::waitpid(child, nullptr, 0);
  const auto left = find_orphaned_autosave(scene);
  ASSERT_TRUE(left);
  EXPECT_EQ(left->text, std::string(9000, 'x'));
}

TEST(Autosave, AnotherSceneReplacesTheDraftAndWriteErrorsAreReported) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.json", kScene);
  test::write_file(folder / "b.json", kScene);
  const StateHome state(folder / "a.json/no_folder");
  Autosave draft;
  ASSERT_TRUE(draft.save_text(folder / "a.json", "a"));
  ASSERT_TRUE(draft.save_text(folder / "b.json", "b"));
  const auto files = drafts_in(folder.path());
  ASSERT_EQ(files.size(), 1u);
  EXPECT_NE(files[0].find("b.json.unsaved-"), std::string::npos);
  const Outcome none = draft.save_text(folder / "none/c.json", "c");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("cannot write"), std::string::npos);
}

TEST(Autosave, LinksPipesAndOtherNamesAreNotOffered) {
  const test::TemporaryFolder folder;
  const std::string scene = folder / "a.json", name = scene + ".unsaved-0123456789ab";
  test::write_file(folder / "secret", "secret");
  fs::create_symlink("secret", name);
  EXPECT_FALSE(find_orphaned_autosave(scene)) << "a link";
  fs::remove(name);
  ASSERT_EQ(::mkfifo(name.c_str(), 0600), 0);
  EXPECT_FALSE(find_orphaned_autosave(scene)) << "a pipe";
  fs::remove(name);
  test::write_file(scene + ".unsaved-0123456789aB", "x");
  test::write_file(scene + ".unsaved-0123456789", "x");
  EXPECT_FALSE(find_orphaned_autosave(scene)) << "other names";
}

class ViewerAutosave : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::can_drive_windows()) GTEST_SKIP() << "no Xvfb or no xdotool here";
    test::write_file(folder_ / "flow.json", kScene);
  }
  std::string log() const { return test::read_file(folder_ / "log"); }
  bool logged(const std::string& text) const { return log().find(text) != std::string::npos; }
  test::TemporaryFolder folder_;
};

// An edit without panels: changes the view, saves the scene under another name, and undoes the change.
constexpr const char* kChange =
    "keys o ctrl+shift+s; sleep 0.3; xdotool type --delay 60 'copy'; keys Return; written copy.json\n"
    "keys ctrl+z; titled 'copy.json [^ ]'\n";

TEST_F(ViewerAutosave, IsOfferedAfterTheProcessWasKilled) {
  const int code =
      test::drive_windows(folder_, "view flow.json --size 900x600\n" + std::string(kChange) +
                                       "until_ sh -c 'ls copy.json.unsaved-*' || echo 'never kept'\n"
                                       "kill -9 $V; wait $V\n"
                                       "cp copy.json saved.json\n"
                                       // Later: nothing changes, and the draft is offered again.
                                       "view copy.json --size 900x600\nsleep 2; keys Escape ctrl+q; wait $V || echo 'bad end'\n"
                                       "cmp copy.json saved.json || echo changed\nls copy.json.unsaved-* || echo 'lost'\n"
                                       // Restore, then save.
                                       "view copy.json --size 900x600\nsleep 2; keys Return; titled 'copy.json [^ ]'\n"
                                       "keys ctrl+s; titled 'copy.json  '; keys ctrl+q; wait $V || echo 'bad end'\n"
                                       "ls copy.json.unsaved-* 2> /dev/null && echo 'still there'\n"
                                       // No draft is offered after the save.
                                       "view copy.json --size 900x600\nsleep 2; keys ctrl+q; wait $V\nexit $?\n");
  EXPECT_EQ(code, 0) << log();
  for (const char* bad : {"never", "lost", "changed", "bad end", "still there"}) EXPECT_FALSE(logged(bad)) << bad << "\n" << log();
  EXPECT_EQ(test::read_file(folder_ / "copy.json"), kScene) << "what was undone, restored and saved";
  EXPECT_NE(test::read_file(folder_ / "saved.json"), kScene);
}

TEST_F(ViewerAutosave, IsKeptAfterAnInterruptAndRemovedWhenDiscarded) {
  const int code = test::drive_windows(
      folder_, "view flow.json --size 900x600\n" + std::string(kChange) +
                   "until_ sh -c 'ls copy.json.unsaved-*' || echo 'never kept'\n"
                   "kill -TERM $V; wait $V\nls copy.json.unsaved-* || echo 'lost'\n"
                   // The draft is discarded with the second button, to the right of Restore.
                   "view copy.json --size 900x600\nsleep 2; keys Return; titled 'copy.json [^ ]'\n"
                   "keys ctrl+q; sleep 0.3; keys Escape ctrl+z; titled 'copy.json  '; keys ctrl+q; wait $V || echo 'bad end'\n"
                   "ls copy.json.unsaved-* 2> /dev/null && echo 'still there'\nexit 0\n");
  EXPECT_EQ(code, 0) << log();
  for (const char* bad : {"never", "lost", "bad end", "still there"}) EXPECT_FALSE(logged(bad)) << bad << "\n" << log();
}

// Saving must not silently replace what another program wrote to the file.
TEST_F(ViewerAutosave, AFileChangedByAnotherProgramIsNotReplacedWithoutAsking) {
  const int code = test::drive_windows(
      folder_,
      "view flow.json --size 900x600\nkeys o\n"
      "sed 's/circle/saddle/' flow.json > theirs.json; cp theirs.json flow.json\n"
      "keys ctrl+s; sleep 0.5; keys Escape; sleep 0.3; cmp flow.json theirs.json || echo 'replaced'\n"
      // Enter chooses Save as.
      "keys ctrl+s; sleep 0.5; keys Return; sleep 0.5; keys ctrl+a; xdotool type --delay 60 'mine'; keys Return; written mine.json\n"
      "cmp flow.json theirs.json || echo 'replaced'\n"
      // A scene file that was removed is not written again without asking.
      "titled 'mine.json'; rm mine.json; keys ctrl+s; sleep 0.5; ls mine.json 2> /dev/null && echo 'made again'\n"
      "kill -TERM $V; wait $V; exit 0\n");
  EXPECT_EQ(code, 0) << log();
  for (const char* bad : {"never", "replaced", "made again"}) EXPECT_FALSE(logged(bad)) << bad << "\n" << log();
}

TEST_F(ViewerAutosave, QuitAsksDuringARecordingAndOnlyCtrlQQuits) {
  ASSERT_EQ(test::drive_window(folder_, "flow.json --size 900x600 --record run.catlog",
                               "titled 'recording'\n"
                               "keys q Q Escape Escape Escape; kill -0 $V && echo 'after Q'\n"
                               "keys ctrl+q; sleep 0.3; kill -0 $V && echo 'asked'\n"
                               "keys Escape; sleep 0.3; titled 'recording'; kill -0 $V && echo 'stayed'\n"
                               "keys ctrl+q; sleep 0.3; keys Return"),
            0)
      << log();
  for (const char* good : {"after Q", "asked", "stayed"}) EXPECT_TRUE(logged(good)) << good << "\n" << log();
  EXPECT_FALSE(logged("never")) << log();
  EXPECT_TRUE(test::exists(folder_ / "run.catlog"));
}

// A recording must contain its last ticks when a signal ends the window.
TEST_F(ViewerAutosave, ARecordingIsCompleteAfterSigterm) {
  ASSERT_EQ(test::drive_windows(folder_,
                                "view flow.json --size 900x600 --record run.catlog\ntitled 'recording'; sleep 0.5\n"
                                "kill -TERM $V; wait $V; exit 0\n"),
            0)
      << log();
  const auto run = test::run_catena({"info", folder_ / "run.catlog"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "") << "it is whole";
  EXPECT_EQ(test::run_catena({"replay", "--log", folder_ / "run.catlog"}).exit_code, 0);
}

TEST_F(ViewerAutosave, EscapeClosesAMenuFirst) {
  ASSERT_EQ(test::drive_window(folder_, "flow.json --size 900x600",
                               "xdotool mousemove 600 300; sleep 0.3; keys shift+F12; written flow-001.png\n"
                               "xdotool mousemove 20 8 click 1; sleep 0.4; xdotool mousemove 600 300; sleep 0.3\n"
                               "keys shift+F12; written flow-002.png\n"
                               "keys Escape; sleep 0.4; keys shift+F12; written flow-003.png\n"
                               "keys Escape Escape; kill -0 $V && echo 'stayed'\nkeys ctrl+q"),
            0)
      << log();
  EXPECT_TRUE(logged("stayed")) << log();
  const auto closed = render::read_png(folder_ / "flow-001.png"), open = render::read_png(folder_ / "flow-002.png"),
             after = render::read_png(folder_ / "flow-003.png");
  ASSERT_TRUE(closed && open && after) << log();
  const auto differing = [&](const render::Image8& a) {
    int count = 0;
    for (std::uint32_t y = 24; y < 140; ++y)
      for (std::uint32_t x = 8; x < 150; ++x) count += std::abs(a.pixel(x, y)[0] - closed->pixel(x, y)[0]) > 20;
    return count;
  };
  EXPECT_GT(differing(*open), 1000) << "the menu covers the panel";
  EXPECT_LT(differing(*after), 200);
}

}  // namespace autosave_test
}  // namespace catena::app
