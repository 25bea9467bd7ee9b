// SPDX-License-Identifier: MIT
// External plug-ins: the program loads a constraint that is not part of its tree, or refuses it with an error in one line. As root it
// loads none; if root runs the tests, the program is run as nobody.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "tests/support/drive_window.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace plugin_test {

namespace fs = std::filesystem;
namespace test = catena::test;

constexpr uid_t kNobody = 65534;
constexpr const char* kScene = R"({"fields": {"ball": {"analytic": "sphere"}},
 "chain": [{"name": "skin", "type": "shell", "field": "ball", "level": 1}], "workspace": {"metres_per_unit": 0.05},
 "isosurfaces": [{"field": "ball", "level": 1}]})";

struct Plugin : testing::Test {
  Plugin() {
    fs::permissions(folder.path(), fs::perms(0755));
    for (const char* name : {"data", "data/catena", "data/catena/plugins", "out"}) fs::create_directory(folder / name);
    if (::geteuid() == 0) {
      EXPECT_EQ(::chown((folder / "out").c_str(), kNobody, kNobody), 0);
    }
    test::write_file(scene, kScene);
    test::write_file(folder / "path.csv", "t,x,y,z\n0,1.5,0,0\n0.001,0.9,0,0\n0.002,0.8,0.1,0\n");
  }

  /// Arguments of env: the program as a user other than root, with variables ("NAME=VALUE") and the folder's plug-ins.
  std::vector<std::string> words(const std::vector<std::string>& arguments, const std::vector<std::string>& variables = {}) const {
    std::vector<std::string> all{"-u", "CATENA_PLUGINS", "HOME=" + (folder / "out"), "XDG_DATA_HOME=" + (folder / "data"),
                                 "CATENA_TEST_MARK=" + mark};
    all.insert(all.end(), variables.begin(), variables.end());
    if (::geteuid() == 0) all.insert(all.end(), {"setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"});
    all.push_back(test::program_path());
    all.insert(all.end(), arguments.begin(), arguments.end());
    return all;
  }
  test::ProgramResult run(const std::vector<std::string>& arguments, const std::vector<std::string>& variables = {}) const {
    return test::run_program("/usr/bin/env", words(arguments, variables));
  }
  test::ProgramResult keys(const std::vector<std::string>& variables, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"info", "--keys", "chain"});
    return run(more, variables);
  }
  /// Expects exit code 2 and one line with the expected text.
  static void expect_refused(const test::ProgramResult& result, const std::string& expected) {
    EXPECT_EQ(result.exit_code, 2) << expected << ": " << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_NE(result.err.find(expected), std::string::npos) << "expected " << expected << " in " << result.err;
  }
  /// A copy of level_ball.so in the folder with a text replaced by one of equal length, so that offsets stay valid.
  std::string changed(const std::string& name, const std::string& from, const std::string& to) const {
    std::string bytes = test::read_file(shell);
    const std::size_t at = bytes.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at != std::string::npos) bytes.replace(at, to.size(), to);
    test::write_file(folder / name, bytes);
    return folder / name;
  }

  test::TemporaryFolder folder;
  const std::string scene = folder / "s.json", mark = folder / "out/mark", shell = test::binary_dir() + "/level_ball.so",
                    strange = test::binary_dir() + "/misbehaving.so";
};

TEST_F(Plugin, IsLoadedByOptionVariableAndFolder) {
  const std::string expected = "Holds the proxy on a ball that is as large as a level. Paper: of no paper. From the plug-in level_ball.so.";
  const std::string known = keys({}, {"--plugin", shell}).out;
  EXPECT_NE(known.find("shell"), std::string::npos) << known;
  EXPECT_EQ(keys({"CATENA_PLUGINS=:" + shell + ":" + shell}).out, known);
  EXPECT_NE(run({"info", "--schema", "--plugin", shell}).out.find(expected), std::string::npos);
  EXPECT_EQ(keys({}).out.find("shell"), std::string::npos);
  fs::copy_file(shell, folder / "data/catena/plugins/level_ball.so");
  EXPECT_EQ(keys({}).out, known);
  EXPECT_EQ(keys({}, {"--plugin", shell}).err, "") << "the same file twice";
  for (const char* command : {"info", "view", "render", "feel", "replay", "serve", "tradeoff", "export"})
    EXPECT_NE(run({command, "--help"}).out.find("--plugin"), std::string::npos) << command;
  EXPECT_NE(run({"study", "simulate", "--help"}).out.find("--plugin"), std::string::npos);
}

TEST_F(Plugin, ReplayIsExactAndNeedsThePlugin) {
  const std::vector<std::string> along{"replay", scene, "--probe", folder / "path.csv", "-o", folder / "out/t.csv"};
  expect_refused(run(along), "unknown constraint type \"shell\"");
  std::vector<std::string> with = along;
  with.insert(with.end(), {"--plugin", shell});
  ASSERT_EQ(run(with).exit_code, 0) << run(with).err;
  const test::Table ticks = test::Table::read(folder / "out/t.csv");
  EXPECT_EQ(ticks.number(1, "skin_x"), 1);
  EXPECT_EQ(ticks.text(1, "skin_status"), "OK");

  const std::string record = folder / "out/r.catlog";
  const auto felt = run({"feel", scene, "--device", "emulated-falcon", "--seconds", "0.2", "--record", record, "--plugin", shell});
  ASSERT_EQ(felt.exit_code, 0) << felt.err;
  EXPECT_NE(run({"info", record}).out.find("  plug-in      level_ball.so ("), std::string::npos);
  EXPECT_NE(run({"info", record, "--json"}).out.find("\"plugins\":[\"level_ball.so ("), std::string::npos);
  const auto again = run({"replay", "--log", record, "--plugin", shell});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(again.out.find("all bit-identical"), std::string::npos) << again.out;
  expect_refused(run({"replay", "--log", record}), "link \"skin\" ran in the plug-in level_ball.so (");
  test::write_file(folder / "other.so", test::read_file(shell) + "another build");
  expect_refused(run({"replay", "--log", record, "--plugin", folder / "other.so"}), "this file was expected, but other.so (");
}

TEST_F(Plugin, IncompatibleFilesAreRefusedWithoutRunningThem) {
  const std::string bytes = test::read_file(shell);
  test::write_file(folder / "half.so", bytes.substr(0, bytes.size() / 2));
  test::write_file(folder / "text.so", "a text\n");
  test::write_file(folder / "open.so", bytes);
  fs::permissions(folder / "open.so", fs::perms(0666));
  fs::create_directory(folder / "all");
  fs::permissions(folder / "all", fs::perms(0777));
  test::write_file(folder / "all/level_ball.so", bytes);
  ASSERT_EQ(::mkfifo((folder / "pipe.so").c_str(), 0644), 0);
  const std::size_t statement = bytes.find("Catena plug-in");
  ASSERT_NE(statement, std::string::npos);
  const std::string headers = bytes.c_str() + statement + 16, compiler = bytes.c_str() + statement + 80;
  struct Wrong {
    std::string file, expected;
  };
  std::vector<Wrong> all{{changed("headers.so", headers, "9.9.9"), "was built for Catena 9.9.9"},
                         {changed("compiler.so", compiler, "XYZ"), "was built by XYZ"},
                         {changed("mark.so", "Catena plug-in", "Catena plug-im"), "has no plug-in interface"},
                         {folder / "half.so", "is truncated"},
                         {folder / "text.so", "is not a shared library"},
                         {folder.path(), "a plug-in was expected"},
                         {folder / "pipe.so", "is a pipe"},
                         {folder / "none.so", "No such file"},
                         {folder / "open.so", "can be written by others"},
                         {folder / "all/level_ball.so", "can be written by others"},
                         {"", "a plug-in was expected"}};
  if (::geteuid() == 0) {
    test::write_file(folder / "foreign.so", bytes);
    ASSERT_EQ(::chown((folder / "foreign.so").c_str(), 1, 1), 0);
    all.push_back({folder / "foreign.so", "belongs to another user"});
  }
  if (const std::string linked = test::binary_dir() + "/linked.so"; test::exists(linked)) all.push_back({linked, "loads Catena twice"});
  for (const Wrong& wrong : all) {
    expect_refused(run({"info", scene, "--plugin", wrong.file}), wrong.expected);
    EXPECT_FALSE(test::exists(mark)) << wrong.file;
  }
  expect_refused(run({"info", scene}, {"CATENA_PLUGINS=" + folder.path() + "/text.so"}), "CATENA_PLUGINS: ");
  expect_refused(run({"info", scene}, {"CATENA_PLUGINS=level_ball.so"}), "absolute paths");
  fs::copy_file(folder / "compiler.so", folder / "data/catena/plugins/old.so");
  const auto noted = keys({});
  EXPECT_EQ(noted.exit_code, 0);
  EXPECT_NE(noted.err.find("note: plug-in not loaded: "), std::string::npos) << noted.err;
  EXPECT_FALSE(test::exists(mark));
  EXPECT_EQ(keys({}, {"--plugin", shell}).exit_code, 0);
  EXPECT_TRUE(test::exists(mark)) << "the mark shows what has run";
}

TEST_F(Plugin, ItsOutputsAreChecked) {
  const std::pair<const char*, const char*> all[] = {{"throws early", "misbehaving.so: throws an exception when loaded"},
                                                     {"crashes early", "misbehaving.so: crashes (signal 6) when loaded"},
                                                     {"throws", "threw an exception (no such luck)"},
                                                     {"throws a number", "threw an exception"},
                                                     {"no word", "defines a type named \"\""},
                                                     {"no name", "defines a type named \"Two Words\""},
                                                     {"catena's", "\"plane\", which exists in Catena"},
                                                     {"a mode's", "\"anisotropic_friction\", which exists in Catena"},
                                                     {"shell's", "\"shell\", which the plug-in level_ball.so already defines"},
                                                     {"no build", "without a build function"},
                                                     {"a key of every link", "the key \"snap\""},
                                                     {"twice", "\"strange\" twice"}};
  for (const auto& [wrong, expected] : all)
    expect_refused(keys({std::string("CATENA_TEST_WRONG=") + wrong}, {"--plugin", shell, "--plugin", strange}), expected);
  test::write_file(scene, R"({"chain": [{"name": "a", "type": "strange"}]})");
  expect_refused(run({"info", scene, "--plugin", strange}), "s.json:1: the plug-in misbehaving.so built nothing");
  expect_refused(run({"info", scene, "--plugin", strange}, {"CATENA_TEST_WRONG=build throws"}), "threw an exception (no such luck)");
}

TEST_F(Plugin, AScenesKeyCannotLoadOne) {
  test::write_file(scene, R"({"plugin": ")" + shell + R"("})");
  expect_refused(run({"info", scene}), "plugin");
  test::write_file(scene,
                   R"({"chain": [{"name": "a", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "plugin": ")" + shell + "\"}]}");
  expect_refused(run({"info", scene}), "plugin");
  EXPECT_FALSE(test::exists(mark));
}

TEST_F(Plugin, NothingIsLoadedAsRootOrInSetIdPrograms) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root has rights to give";
  fs::copy_file(shell, folder / "data/catena/plugins/level_ball.so");
  const std::string own = folder / "catena";
  const std::vector<std::string> as_root{"CATENA_TEST_MARK=" + mark, "XDG_DATA_HOME=" + (folder / "data")};
  const auto root = [&](std::vector<std::string> more) {
    more.insert(more.begin(), as_root.begin(), as_root.end());
    return test::run_program("/usr/bin/env", more);
  };
  expect_refused(root({test::program_path(), "info", scene, "--plugin", shell}), "plug-ins are not loaded as root");
  expect_refused(root({"CATENA_PLUGINS=" + shell, test::program_path(), "info", scene}), "plug-ins are not loaded as root");
  const auto folder_only = root({test::program_path(), "info", "--keys", "chain"});
  EXPECT_EQ(folder_only.exit_code, 0);
  EXPECT_NE(folder_only.err.find("plug-ins are not loaded as root"), std::string::npos) << folder_only.err;
  EXPECT_EQ(folder_only.out.find("shell"), std::string::npos);

  struct statvfs disk {};
  ASSERT_EQ(::statvfs(folder.path().c_str(), &disk), 0);
  if ((disk.f_flag & ST_NOSUID) != 0) GTEST_SKIP() << "no set-id programs on this disk";
  fs::copy_file(test::program_path(), own);
  ASSERT_EQ(::chown(own.c_str(), 1, 1), 0);
  for (const mode_t mode : {04755, 02755}) {
    ASSERT_EQ(::chmod(own.c_str(), mode), 0);
    const auto set_id = root({"setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", own, "info", scene, "--plugin", shell});
    expect_refused(set_id, "more rights than its user");
  }
  EXPECT_FALSE(test::exists(mark));
}

TEST_F(Plugin, TheWindowListsIt) {
  if (!test::can_drive_windows()) GTEST_SKIP() << "no Xvfb or no xdotool here";
  std::string command = "timeout 90 " + test::on_display("640x480") + "env";
  for (const std::string& word :
       words({"view", scene, "--plugin", shell, "--size", "600x400", "--frames", "10", "--screenshot-ui", folder / "out/w.png"}))
    command += " '" + word + "'";
  const auto shown = test::run_program("/bin/sh", {"-c", command});
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_TRUE(test::exists(folder / "out/w.png"));
}

}  // namespace plugin_test
