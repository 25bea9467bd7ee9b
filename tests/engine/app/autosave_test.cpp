// SPDX-License-Identifier: MIT
// Autosave keeps unsaved edits when the window is killed, closed by a key or closed by its close button.
#include "engine/app/viewer/scene/autosave.h"

#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "tests/engine/app/environment_variable.h"
#include "tests/engine/app/window_fixture.h"
#include "tests/support/results.h"

namespace catena::app::autosave_test {

using test::fails;

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

TEST(Autosave, ADataFilesDraftLiesInTheStateFolderUntilItsSceneIsSaved) {
  const test::TemporaryFolder data, other, home;
  const test::EnvironmentVariable state("XDG_STATE_HOME", home / "state");
  const std::string scene = data / "head.nii.json", unsaved = home / "state/catena/unsaved";
  test::write_file(data / "head.nii", "data");
  {
    Autosave draft;
    ASSERT_TRUE(draft.save_text(scene, "one"));
    EXPECT_EQ(std::distance(fs::directory_iterator(data.path()), fs::directory_iterator()), 1) << "the data alone";
    ASSERT_EQ(drafts_in(unsaved).size(), 1u);
  }
  EXPECT_FALSE(find_orphaned_autosave(other / "head.nii.json")) << "a file of that name elsewhere";
  const OrphanedAutosave left = find_orphaned_autosave(scene).value();
  EXPECT_EQ(left.text, "one");
  remove_orphaned_autosave(left);
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
  const OrphanedAutosave left = find_orphaned_autosave(scene).value();
  EXPECT_EQ(left.text, "two");
  EXPECT_FALSE(find_orphaned_autosave(folder / "b.json"));
  remove_orphaned_autosave(left);
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
  EXPECT_EQ(find_orphaned_autosave(scene).value().text, std::string(9000, 'x'));
}

TEST(Autosave, AnotherSceneReplacesTheDraftAndWriteErrorsAreReported) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.json", kScene);
  test::write_file(folder / "b.json", kScene);
  const test::EnvironmentVariable state("XDG_STATE_HOME", folder / "a.json/no_folder");
  Autosave draft;
  ASSERT_TRUE(draft.save_text(folder / "a.json", "a"));
  ASSERT_TRUE(draft.save_text(folder / "b.json", "b"));
  const auto files = drafts_in(folder.path());
  ASSERT_EQ(files.size(), 1u);
  EXPECT_NE(files[0].find("b.json.unsaved-"), std::string::npos);
  EXPECT_TRUE(fails(draft.save_text(folder / "none/c.json", "c"), "cannot write"));
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

class ViewerAutosave : public test::DrivenWindow {
 protected:
  void SetUp() override {
    DrivenWindow::SetUp();
    test::write_file(folder_ / "flow.json", kScene);
  }
  bool logged(const std::string& text) const { return log().find(text) != std::string::npos; }
  /// Plays a script that opens its windows; none of the words may be in the log.
  void expect_played(const std::string& script, const std::vector<std::string>& bad) {
    EXPECT_EQ(test::drive_windows(folder_, script), 0) << log();
    for (const std::string& word : bad) EXPECT_FALSE(logged(word)) << word << "\n" << log();
  }
};

// An edit without panels: changes the view, saves the scene under another name, and undoes the change.
constexpr const char* kChange =
    "keys o ctrl+shift+s; sleep 0.3; xdotool type --delay 60 'copy'; keys Return; written copy.json\n"
    "keys ctrl+z; titled 'copy.json [^ -]'\n";

TEST_F(ViewerAutosave, IsOfferedAfterTheProcessWasKilled) {
  expect_played("view flow.json --size 900x600\n" + std::string(kChange) +
                    "until_ sh -c 'ls copy.json.unsaved-*' || echo 'never kept'\n"
                    "kill -9 $V; wait $V\n"
                    "cp copy.json saved.json\n"
                    // Later: nothing changes, and the draft is offered again.
                    "view copy.json --size 900x600\nsleep 2; keys Escape ctrl+q; wait $V || echo 'bad end'\n"
                    "cmp copy.json saved.json || echo changed\nls copy.json.unsaved-* || echo 'lost'\n"
                    // Restore, then save.
                    "view copy.json --size 900x600\nsleep 2; keys Return; titled 'copy.json [^ -]'\n"
                    "keys ctrl+s; titled 'copy.json - '; keys ctrl+q; wait $V || echo 'bad end'\n"
                    "ls copy.json.unsaved-* 2> /dev/null && echo 'still there'\n"
                    // No draft is offered after the save.
                    "view copy.json --size 900x600\nsleep 2; keys ctrl+q; wait $V\nexit $?\n",
                {"never", "lost", "changed", "bad end", "still there"});
  EXPECT_EQ(test::read_file(folder_ / "copy.json"), kScene) << "what was undone, restored and saved";
  EXPECT_NE(test::read_file(folder_ / "saved.json"), kScene);
}

TEST_F(ViewerAutosave, IsKeptAfterAnInterruptAndRemovedWhenDiscarded) {
  expect_played("view flow.json --size 900x600\n" + std::string(kChange) +
                    "until_ sh -c 'ls copy.json.unsaved-*' || echo 'never kept'\n"
                    "kill -TERM $V; wait $V\nls copy.json.unsaved-* || echo 'lost'\n"
                    // The draft is discarded with the second button, to the right of Restore.
                    "view copy.json --size 900x600\nsleep 2; keys Return; titled 'copy.json [^ -]'\n"
                    "keys ctrl+q; sleep 0.3; keys Escape ctrl+z; titled 'copy.json - '; keys ctrl+q; wait $V || echo 'bad end'\n"
                    "ls copy.json.unsaved-* 2> /dev/null && echo 'still there'\nexit 0\n",
                {"never", "lost", "bad end", "still there"});
}

// Saving must not silently replace what another program wrote to the file.
TEST_F(ViewerAutosave, AFileChangedByAnotherProgramIsNotReplacedWithoutAsking) {
  expect_played(
      "view flow.json --size 900x600\nkeys o\n"
      "sed 's/circle/saddle/' flow.json > theirs.json; cp theirs.json flow.json\n"
      "keys ctrl+s; sleep 0.5; keys Escape; sleep 0.3; cmp flow.json theirs.json || echo 'replaced'\n"
      // Enter chooses Save as.
      "keys ctrl+s; sleep 0.5; keys Return; sleep 0.5; keys ctrl+a; xdotool type --delay 60 'mine'; keys Return; written mine.json\n"
      "cmp flow.json theirs.json || echo 'replaced'\n"
      // A scene file that was removed is not written again without asking.
      "titled 'mine.json'; rm mine.json; keys ctrl+s; sleep 0.5; ls mine.json 2> /dev/null && echo 'made again'\n"
      "kill -TERM $V; wait $V; exit 0\n",
      {"never", "replaced", "made again"});
}

TEST_F(ViewerAutosave, QuitAsksDuringARecordingAndOnlyCtrlQQuits) {
  play("flow.json --size 900x600 --record run.catlog",
       "titled 'recording'\n"
       "keys q Q Escape Escape Escape; kill -0 $V && echo 'after Q'\n"
       "keys ctrl+q; sleep 0.3; kill -0 $V && echo 'asked'\n"
       "keys Escape; sleep 0.3; titled 'recording'; kill -0 $V && echo 'stayed'\n"
       "keys ctrl+q; sleep 0.3; keys Return");
  for (const char* good : {"after Q", "asked", "stayed"}) EXPECT_TRUE(logged(good)) << good << "\n" << log();
  EXPECT_TRUE(test::exists(folder_ / "run.catlog"));
}

// A recording must contain its last ticks when a signal ends the window.
TEST_F(ViewerAutosave, ARecordingIsCompleteAfterSigterm) {
  expect_played(
      "view flow.json --size 900x600 --record run.catlog\ntitled 'recording'; sleep 0.5\n"
      "kill -TERM $V; wait $V; exit 0\n",
      {});
  EXPECT_EQ(test::run_ok({"info", folder_ / "run.catlog"}).err, "") << "it is whole";
  test::run_ok({"replay", "--log", folder_ / "run.catlog"});
}

TEST_F(ViewerAutosave, EscapeClosesAMenuFirst) {
  play("flow.json --size 900x600",
       "xdotool mousemove 600 300; sleep 0.3; keys shift+F12; written flow-001.png\n"
       "xdotool mousemove 20 8 click 1; sleep 0.4; xdotool mousemove 600 300; sleep 0.3\n"
       "keys shift+F12; written flow-002.png\n"
       "keys Escape; sleep 0.4; keys shift+F12; written flow-003.png\n"
       "keys Escape Escape; kill -0 $V && echo 'stayed'\nkeys ctrl+q");
  EXPECT_TRUE(logged("stayed")) << log();
  const render::Image8 closed = picture("flow-001.png"), open = picture("flow-002.png"), after = picture("flow-003.png");
  const auto differing = [&](const render::Image8& a) {
    int count = 0;
    for (std::uint32_t y = 24; y < 140; ++y)
      for (std::uint32_t x = 8; x < 150; ++x) count += std::abs(a.pixel(x, y)[0] - closed.pixel(x, y)[0]) > 20;
    return count;
  };
  EXPECT_GT(differing(open), 1000) << "the menu covers the panel";
  EXPECT_LT(differing(after), 200);
}

}  // namespace catena::app::autosave_test
