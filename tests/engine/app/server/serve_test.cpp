// SPDX-License-Identifier: MIT
/// `catena serve` with a client: images, the probe, edits, and control by one client.

#include <fcntl.h>
#include <sys/stat.h>

#include <ctime>
#include <filesystem>

#include "engine/base/folder_lock.h"
#include "tests/engine/app/environment_variable.h"
#include "tests/engine/app/program_runs.h"
#include "tests/engine/app/server/serve_process.h"

namespace serve_test {

namespace test = catena::test;
using catena::json::Node;

// A sphere with a link to its surface.
constexpr const char* kBall = R"({
  "fields": {"ball": {"analytic": "sphere"}},
  "chain": [{"name": "skin", "type": "isosurface", "field": "ball", "level": 1, "free": "above", "release": 0.5}],
  "isosurfaces": [{"field": "ball", "level": 1}],
  "camera": {"position": [0, -5, 0], "target": [0, 0, 0]}
})";

std::string write_scene(const test::TemporaryFolder& folder, const std::string& text) {
  test::write_file(folder / "ball.json", text);
  return folder / "ball.json";
}
std::string write_ball(const test::TemporaryFolder& folder) { return write_scene(folder, kBall); }

/// A served scene, and a page that shows it.
struct Served {
  explicit Served(const std::string& scene = kBall) : Served([&](const test::TemporaryFolder& in) { return write_scene(in, scene); }) {}
  /// `make` writes the files and returns the path of the source.
  explicit Served(const std::function<std::string(const test::TemporaryFolder&)>& make, const test::Words& options = {})
      : path(make(folder)), process(path, options), page(process.page()) {
    EXPECT_NE(process.port(), 0) << process.err();
  }
  Node wait(const std::string& key, const std::function<bool(const Node&)>& wanted = {}) {
    return test::wait_for_message(*page, key, wanted);
  }
  /// Sends a request, and waits for a message.
  Node ask(const std::string& request, const std::string& key, const std::function<bool(const Node&)>& wanted = {}) {
    page->send(request);
    return wait(key, wanted);
  }
  void expect_end() {
    EXPECT_EQ(process.interrupt_and_wait(), 0);
    EXPECT_EQ(process.err(), "");
  }
  test::TemporaryFolder folder;
  std::string path;
  test::ServeProcess process;
  std::unique_ptr<test::WebSocketClient> page;
};

double number_of(const Node& node, const char* key) { return node.find(key) != nullptr ? node.find(key)->number : -1; }
std::string word_of(const Node& node, const char* key) { return node.find(key) != nullptr ? node.find(key)->string : ""; }
double level_of(const Node& scene) { return number_of(scene.find("isosurfaces")->items.at(0), "level"); }
/// Whether a state has a time step, or a scene the level of its surface.
auto step_is(int wanted) {
  return [wanted](const Node& s) { return number_of(*s.find("step"), "now") == wanted; };
}
auto level_is(double wanted) {
  return [wanted](const Node& s) { return level_of(s) == wanted; };
}

TEST(Serve, AClientSeesNavigatesFeelsAndEdits) {
  Served served;
  const auto& page = served.page;
  ASSERT_TRUE(page->is_open());
  EXPECT_EQ(word_of(served.wait("role"), "control"), "yours");
  // The first image is coarse; at rest, every pixel is exact.
  const test::SentFrame first = test::wait_for_frame(*page);
  EXPECT_TRUE(first.file.starts_with("\xff\xd8\xff")) << "JPEG";
  EXPECT_EQ(first.width, 160u);
  const test::SentFrame last = test::wait_for_frame(*page, [](const test::SentFrame& p) { return p.exact; });
  EXPECT_TRUE(last.file.starts_with("\x89PNG"));
  // An orbit: the image that shows it has the request's number.
  page->send(R"({"do": "move", "number": 5, "pieces": [[80, 60, 20, 0, 0, 1]]})");
  const test::SentFrame turned = test::wait_for_frame(*page, [](const test::SentFrame& p) { return p.motion == 5; });
  EXPECT_GT(turned.number, last.number);
  page->send(R"({"do": "first_view"})");
  // A change of the size.
  page->send(R"({"do": "size", "width": 200, "height": 100})");
  EXPECT_EQ(test::wait_for_frame(*page, [](const test::SentFrame& p) { return p.width == 200; }).height, 100u);
  // The probe moves onto the sphere, and the wheel pushes it in.
  page->send(R"({"do": "move", "number": 6, "pieces": [[100, 50, 0, 0, 0, 0]]})");
  page->send(R"({"do": "probe"})");
  // The probe starts beyond the release depth: the wheel moves it out, and in again.
  page->send(R"({"do": "move", "number": 7, "pieces": [[100, 50, 0, 0, -5, 0]]})");
  served.wait("state", [](const Node& state) {
    const Node* links = state.find("links");
    return links != nullptr && links->items.size() == 1 && word_of(links->items[0], "status") == "FREE";
  });
  page->send(R"({"do": "move", "number": 8, "pieces": [[100, 50, 0, 0, 9, 0]]})");
  const Node pushed = served.wait("state", [](const Node& state) { return number_of(state, "force") > 0.05; });
  EXPECT_TRUE(pushed.find("probe") != nullptr && pushed.find("probe")->boolean);
  ASSERT_TRUE(pushed.find("links") != nullptr && pushed.find("links")->items.size() == 1);
  EXPECT_EQ(word_of(pushed.find("links")->items[0], "name"), "skin");
  // A smaller sphere, for the image and the link: the probe is outside.
  page->send(R"({"do": "level", "item": "isosurfaces[0]", "value": 0.5})");
  double force = -1;
  const Node scene = test::wait_for_message(*page, "scene", level_is(0.5), [&](const Node& message) {
    if (const Node* state = message.find("state")) force = number_of(*state, "force");
  });
  EXPECT_EQ(word_of(scene, "name"), "ball.json");
  if (force != 0) force = number_of(served.wait("state", [](const Node& s) { return number_of(s, "force") == 0; }), "force");
  EXPECT_EQ(force, 0);
  // Invalid requests are answered with a note, and change nothing.
  for (const char* bad : {R"({"do": "level", "item": "isosurfaces[7]", "value": 1})", R"({"do": "map", "item": "volumes[0]", "name": "x"})",
                          R"({"do": "quit"})", "nonsense"}) {
    EXPECT_TRUE(served.ask(bad, "note").kind == catena::json::Kind::string) << bad;
  }
  served.expect_end();
  EXPECT_FALSE(page->read() && page->read() && page->read() && page->read() && page->read());
  EXPECT_TRUE(test::has(served.process.out(), " images for at most 1 page at a time"));
  EXPECT_EQ(test::read_file(served.path), kBall) << "nothing is written to the scene";
}

TEST(Serve, OneClientHasControlAndOthersWatch) {
  Served served;
  const auto& first = served.page;
  EXPECT_EQ(word_of(served.wait("role"), "control"), "yours");
  const auto second = served.process.page();
  const auto control_of_second = [&] { return word_of(test::wait_for_message(*second, "role"), "control"); };
  EXPECT_EQ(control_of_second(), "taken");
  EXPECT_EQ(number_of(served.wait("role", [](const Node& r) { return number_of(r, "viewers") == 2; }), "viewers"), 2);
  EXPECT_NE(test::wait_for_frame(*second).number, 0u);
  // Requests of a viewer without control change nothing.
  second->send(R"({"do": "level", "item": "isosurfaces[0]", "value": 0.25})");
  second->send(R"({"do": "take_control"})");
  first->send(R"({"do": "level", "item": "isosurfaces[0]", "value": 0.75})");
  std::vector<double> levels;
  test::wait_for_message(*second, "scene", [&](const Node& scene) {
    levels.push_back(level_of(scene));
    return levels.back() == 0.75;
  });
  for (const double level : levels) EXPECT_NE(level, 0.25);
  // Control is free after its client has disconnected.
  first->close();
  EXPECT_EQ(control_of_second(), "free");
  second->send(R"({"do": "take_control"})");
  EXPECT_EQ(control_of_second(), "yours");
  second->send(R"({"do": "release_control"})");
  EXPECT_EQ(control_of_second(), "free");
  const auto third = served.process.page();
  EXPECT_EQ(word_of(test::wait_for_message(*third, "role"), "control"), "yours") << "who comes while it is free";
  EXPECT_EQ(served.process.interrupt_and_wait(), 0);
}

TEST(Serve, TheTransferFunctionOfAVolumeIsEdited) {
  Served served(R"({"fields": {"f": {"analytic": "sphere", "resolution": 24}},
    "volumes": [{"field": "f", "color": "viridis", "opacity": [[0, 0], [2, 0.5]]}], "camera": {"position": [0, -6, 0], "target": [0, 0, 0]}})");
  const auto volume = [](const Node& scene) { return scene.find("volumes")->items.at(0); };
  const Node scene = served.ask(R"({"do": "opacity", "item": "volumes[0]", "points": [[0, 0.125], [1, 0.25], [2, 0]]})", "scene",
                                [&](const Node& s) { return volume(s).find("opacity")->items.size() == 3; });
  EXPECT_EQ(volume(scene).find("opacity")->items[1].items[1].number, 0.25);
  const Node mapped = served.ask(R"({"do": "map", "item": "volumes[0]", "name": "magma"})", "scene",
                                 [&](const Node& s) { return word_of(volume(s), "map") == "magma"; });
  EXPECT_EQ(word_of(volume(mapped), "map"), "magma");
  // Values that do not increase are refused, as in a scene file.
  EXPECT_EQ(served.ask(R"({"do": "opacity", "item": "volumes[0]", "points": [[1, 0.1], [0, 0.2]]})", "note").kind,
            catena::json::Kind::string);
}

TEST(Serve, TimeStepsUndoAndRecordings) {
  Served served([](const test::TemporaryFolder& folder) {
    for (const std::string step : {"0", "1", "2"})
      test::run_ok({"generate", "sphere", "--resolution", "12", "--scale", step == "1" ? "2" : "1", "-o", folder / ("a_" + step + ".vdb")});
    test::write_file(folder / "series.json", R"({"fields": {"f": {"file": "a_*.vdb"}}, "isosurfaces": [{"field": "f", "level": 1}],
    "chain": [{"name": "skin", "type": "isosurface", "field": "f", "level": 1, "free": "above"}], "camera": {"position": [0, -5, 0], "target": [0, 0, 0]}})");
    return folder / "series.json";
  });
  const auto& page = served.page;
  EXPECT_EQ(number_of(*served.wait("state").find("step"), "count"), 3);
  // The step after the last is the first.
  for (const auto& [request, step] :
       {std::pair{R"({"do": "step", "value": 1})", 1}, {R"({"do": "next_step"})", 2}, {R"({"do": "next_step"})", 0}})
    EXPECT_EQ(served.ask(request, "state", step_is(step)).kind, catena::json::Kind::object) << step;
  page->send(R"({"do": "play_steps"})");
  for (const int wanted : {1, 2, 0}) EXPECT_EQ(served.wait("state", step_is(wanted)).kind, catena::json::Kind::object) << wanted;
  page->send(R"({"do": "play_steps"})");

  // Undo reverts the edit.
  std::string undo;  // a one-time message may arrive before or after the scene
  const auto look = [&](const Node& message) {
    if (const Node* state = message.find("state")) undo = word_of(*state, "undo");
  };
  page->send(R"({"do": "level", "item": "isosurfaces[0]", "value": 0.5})");
  test::wait_for_message(*page, "scene", level_is(0.5), look);
  if (undo.empty())
    test::wait_for_message(
        *page, "state", [](const Node& state) { return word_of(state, "undo") != ""; }, look);
  EXPECT_EQ(undo, "isolevel");
  EXPECT_EQ(served.ask(R"({"do": "undo"})", "scene", level_is(1)).kind, catena::json::Kind::object);
  EXPECT_EQ(served.ask(R"({"do": "redo"})", "scene", level_is(0.5)).kind, catena::json::Kind::object);

  // The recording can be fetched and is a valid log; the next recording replaces it.
  const auto fetched = [&](const std::string& name) {
    const int port = served.process.port();
    const std::string answer = test::send_raw_request(
        port, test::make_request("/" + name, {{"Host", "127.0.0.1:" + std::to_string(port)}, {"Cookie", served.process.cookie()}}));
    return test::parse_status(answer) == 200 ? answer.substr(answer.find("\r\n\r\n") + 4) : "";
  };
  for (const std::string name : {"recording-1.catlog", "recording-2.catlog"}) {
    served.ask(R"({"do": "record"})", "state",
               [](const Node& s) { return s.find("recording")->find("on")->boolean && number_of(*s.find("recording"), "mb") > 0; });
    EXPECT_EQ(fetched("recording-1.catlog"), "") << "it is not whole, or not there any more";
    served.ask(R"({"do": "stop_recording"})", "state", [&](const Node& s) { return word_of(*s.find("recording"), "file") == name; });
    test::write_file(served.folder / name, fetched(name));
    test::run_ok({"replay", "--log", served.folder / name});
  }
  served.expect_end();
}

TEST(Serve, AddedTimeStepsAreShownOnceComplete) {
  const auto file = [](const test::TemporaryFolder& folder, int step) { return folder / ("a_" + std::to_string(step) + ".vdb"); };
  Served served(
      [&](const test::TemporaryFolder& folder) {
        test::run_ok({"generate", "sphere", "--resolution", "12", "-o", file(folder, 1)});
        return file(folder, 1);
      },
      {"--follow"});
  EXPECT_EQ(number_of(*served.wait("state").find("step"), "count"), 1);
  const std::string bytes = test::read_file(served.path);
  test::write_file(file(served.folder, 2), bytes.substr(0, bytes.size() / 2));
  test::write_file(file(served.folder, 10), bytes);
  const auto newest_is = [](int count) {
    return
        [count](const Node& s) { return number_of(*s.find("step"), "count") == count && number_of(*s.find("step"), "now") == count - 1; };
  };
  served.wait("state", newest_is(2));
  test::write_file(file(served.folder, 2), bytes);
  served.wait("state", newest_is(3));
  served.expect_end();
}

TEST(Serve, HapticTuningIsMeasuredAndChosen) {
  Served served(R"({"fields": {"flow": {"analytic": "circle"}},
    "chain": [{"name": "curve", "type": "streamline", "field": "flow", "seed": [0.5, 0, 0]}],
    "camera": {"position": [0, -5, 0], "target": [0, 0, 0]}})");
  EXPECT_EQ(served.ask(R"({"do": "tune", "position": 0.5})", "note").kind, catena::json::Kind::string) << "nothing is measured yet";
  const auto planned = [](const Node& s) { return s.find("tuning") != nullptr && s.find("tuning")->kind == catena::json::Kind::object; };
  const Node measured = served.ask(R"({"do": "tune"})", "state", planned);
  ASSERT_TRUE(planned(measured));
  EXPECT_NE(word_of(*measured.find("tuning"), "haptics").find("curve"), std::string::npos);
  const Node chosen =
      served.ask(R"({"do": "tune", "position": 0})", "state", [](const Node& s) { return word_of(s, "undo") == "accuracy"; });
  EXPECT_EQ(word_of(chosen, "undo"), "accuracy");
  EXPECT_TRUE(planned(chosen));
}

TEST(Serve, ImageTuningIsMeasuredAndChosen) {
  // A thin soft shell of a smooth field: the most exact setting takes four times as long as the fastest one, so that the load of the
  // machine does not change their order.
  Served served(R"({"fields": {"f": {"analytic": "torus", "resolution": 128}},
    "volumes": [{"field": "f", "opacity": [[-0.2, 0], [0, 0.2], [0.2, 0]]}], "camera": {"position": [0, -4, 2], "target": [0, 0, 0]}})");
  const auto eye = [](const Node& s) {
    const Node* plan = s.find("tuning");
    return plan != nullptr && plan->kind == catena::json::Kind::object ? word_of(*plan, "image") : std::string();
  };
  const std::string measured = eye(served.ask(R"({"do": "tune"})", "state", [&](const Node& s) { return !eye(s).empty(); }));
  EXPECT_NE(measured.find("/255, "), std::string::npos) << measured;
  // The two ends of the slider; the reported position is that of the chosen setting.
  const auto error_of = [](const std::string& words) { return std::stod(words.substr(words.find(": ") + 2)); };
  const auto at = [&](const char* place, double min_position, double max_position) {
    return eye(served.ask(R"({"do": "tune", "position": )" + std::string(place) + "}", "state", [&](const Node& s) {
      const double position = eye(s).empty() ? -1 : number_of(*s.find("tuning"), "position");
      return word_of(s, "undo") == "accuracy" && position >= min_position && position <= max_position;
    }));
  };
  const std::string fast = at("0", 0, 0.5), exact = at("1", 1, 1);
  ASSERT_TRUE(!fast.empty() && !exact.empty()) << fast << " | " << exact;
  EXPECT_LT(error_of(exact), error_of(fast)) << fast << " | " << exact;
  EXPECT_NE(test::wait_for_frame(*served.page, [](const test::SentFrame& p) { return p.exact; }).number, 0u);
  EXPECT_EQ(served.process.interrupt_and_wait(), 0);
}

TEST(Serve, RecordingsOfAKilledServerAreRemovedByTheNext) {
  const test::TemporaryFolder temporary;
  const auto make = [&](const char* name, std::time_t age_s) {
    const std::string path = temporary / name;
    std::filesystem::create_directory(path);
    test::write_file(path + "/recording-1.catlog", "ticks");
    const timespec then{std::time(nullptr) - age_s, 0}, both[2] = {then, then};
    EXPECT_EQ(utimensat(AT_FDCWD, path.c_str(), both, 0), 0);
    return path;
  };
  const std::string left = make("catena-serve-a", 3600), held = make("catena-serve-b", 3600), young = make("catena-serve-c", 0),
                    other = make("somebodys", 3600);
  const auto lock = catena::FolderLock::acquire(held);
  ASSERT_TRUE(lock);
  std::optional<Served> served;
  {
    const test::EnvironmentVariable folder("TMPDIR", temporary.path());
    served.emplace();
  }
  EXPECT_TRUE(test::exists(left)) << "nothing is looked for before somebody records";
  served->ask(R"({"do": "record"})", "state", [](const Node& s) { return s.find("recording")->find("on")->boolean; });
  EXPECT_FALSE(test::exists(left));
  for (const std::string& path : {held, young, other}) EXPECT_TRUE(test::exists(path + "/recording-1.catlog")) << path;
  EXPECT_EQ(served->process.interrupt_and_wait(), 0);
}

TEST(Serve, EndsWhenStandardInputIsClosed) {
  int ends[2] = {-1, -1};
  ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
  const int before = dup(0);
  dup2(ends[0], 0);
  std::optional<Served> served;
  served.emplace(write_ball, test::Words{"--exit-with-stdin"});
  dup2(before, 0);
  for (const int end : {before, ends[0]}) close(end);
  ASSERT_EQ(write(ends[1], "x\n", 2), 2) << "what is said to it is of no interest";
  EXPECT_NE(test::wait_for_frame(*served->page).number, 0u);
  close(ends[1]);
  EXPECT_EQ(test::wait_for_frame(*served->page, [](const test::SentFrame&) { return false; }).number, 0u);
  EXPECT_EQ(served->process.wait(), 0);
}

TEST(Serve, BadInputIsOneLine) {
  const test::TemporaryFolder folder;
  const std::string ball = write_ball(folder);
  for (const test::Words& words : {test::Words{"missing.json"}, {}}) EXPECT_EQ(test::run_refused(test::joined({"serve"}, words)).out, "");
  for (const auto& [option, value] :
       {std::pair{"--address", "localhost"}, {"--port", "99999"}, {"--frame-ancestor", "*"}, {"--quality", "pretty"}})
    EXPECT_EQ(test::run_refused({"serve", ball, option, value}).out, "");
}

}  // namespace serve_test
