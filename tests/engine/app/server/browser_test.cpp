// SPDX-License-Identifier: MIT
/// The page in a headless browser. CATENA_SCREENSHOTS=FOLDER stores screenshots.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/engine/app/server/devtools.h"

namespace browser_test {

namespace test = catena::test;

constexpr const char* kScene = R"({
  "fields": {"flow": {"analytic": "helix"}, "ball": {"analytic": "sphere", "resolution": 32}},
  "chain": [{"name": "skin", "type": "isosurface", "field": "ball", "level": 1, "free": "above", "release": 0.5}],
  "isosurfaces": [{"field": "ball", "level": 1, "color": [0.3, 0.6, 0.9]}],
  "volumes": [{"field": "ball", "color": "viridis", "opacity": [[0, 0], [1.2, 0], [1.6, 0.05], [2, 0]]}],
  "camera": {"position": [0, -5, 1.5], "target": [0, 0, 0]}
})";

void keep(test::Browser& browser, const std::string& name) {
  const std::string picture = browser.screenshot();
  EXPECT_TRUE(picture.starts_with("\x89PNG")) << name;
  if (const char* folder = std::getenv("CATENA_SCREENSHOTS")) test::write_file(folder + ("/" + name + ".png"), picture);
}

TEST(BrowserClient, ThePageShowsNavigatesFeelsAndEdits) {
  if (test::browser_path().empty()) GTEST_SKIP() << "there is no Chromium here: the page is not looked at in a browser";
  const test::TemporaryFolder folder;
  test::write_file(folder / "served.json", kScene);
  test::ServeProcess served(folder / "served.json");
  ASSERT_NE(served.port(), 0) << served.err();
  test::Browser browser("760,420");
  ASSERT_TRUE(browser.is_running());
  browser.open(served.url());
  ASSERT_TRUE(browser.wait_until("window.catena && catena.exact > 0"));
  // The token is removed from the address, and scripts cannot read the cookie.
  EXPECT_EQ(browser.evaluate("location.search").string, "");
  EXPECT_EQ(browser.evaluate("document.cookie").string, "");
  EXPECT_EQ(browser.evaluate("document.title").string, "served.json - catena");
  EXPECT_EQ(browser.evaluate("catena.role").string, "yours");
  // The image has the page's size, and the sphere is at the center.
  EXPECT_TRUE(browser.wait_until("picture.width == Math.round(picture.getBoundingClientRect().width)"));
  ASSERT_TRUE(browser.wait_until("catena.exact > 0"));
  const std::string middle = "pen.getImageData(picture.width * 0.4, picture.height * 0.4, 1, 1).data[2]";
  EXPECT_TRUE(browser.wait_until(middle + " > 60"));
  keep(browser, "rest");

  // A drag orbits the scene, and images of it arrive.
  const int x = static_cast<int>(browser.evaluate_number("picture.getBoundingClientRect().width / 2")),
            y = static_cast<int>(browser.evaluate_number("picture.getBoundingClientRect().height / 2"));
  browser.mouse("mousePressed", x, y, "\"button\": \"left\", \"buttons\": 1, \"clickCount\": 1");
  for (int i = 1; i <= 12; ++i) browser.mouse("mouseMoved", x + 6 * i, y + 3 * i, "\"button\": \"left\", \"buttons\": 1");
  browser.mouse("mouseReleased", x + 72, y + 36, "\"button\": \"left\", \"buttons\": 0, \"clickCount\": 1");
  ASSERT_TRUE(browser.wait_until("catena.latencies.length > 0 && sent.size == 0"));
  keep(browser, "turned");

  // The pointer moves the probe; the wheel pushes the probe into the sphere until there is a force.
  browser.mouse("mouseMoved", x, y);
  browser.key("h");
  ASSERT_TRUE(browser.wait_until("catena.state.probe"));
  // The probe starts beyond the release depth: the wheel moves it out, and in again.
  for (int i = 0; i < 4; ++i) browser.mouse("mouseWheel", x, y, "\"deltaX\": 0, \"deltaY\": 100");
  EXPECT_TRUE(browser.wait_until("catena.state.links[0].status == 'FREE'"));
  for (int i = 0; i < 9; ++i) browser.mouse("mouseWheel", x, y, "\"deltaX\": 0, \"deltaY\": -100");
  EXPECT_TRUE(browser.wait_until("catena.state.force > 0.05"));
  ASSERT_TRUE(browser.wait_until("document.getElementById('felt').textContent.includes('skin')"));
  keep(browser, "felt");

  // The level's slider changes the image and the link.
  browser.evaluate(
      "(() => { const s = document.querySelector('#surfaces input'); s.value = 0.5; s.oninput(); s.onchange(); return 0; })()");
  EXPECT_TRUE(browser.wait_until("catena.scene.isosurfaces[0].level < 0.6"));
  browser.evaluate("(() => { const s = document.querySelector('#volumes select'); s.value = 'magma'; s.onchange(); return 0; })()");
  EXPECT_TRUE(browser.wait_until("catena.scene.volumes[0].map == 'magma'"));
  const double exact = browser.evaluate_number("catena.exact");
  EXPECT_TRUE(browser.wait_until("catena.exact > " + std::to_string(exact)));
  keep(browser, "changed");

  // Undo; no time steps in this scene; a recording, offered as a link.
  const auto click = [&](const std::string& id) { browser.evaluate("document.getElementById('" + id + "').click()"); };
  EXPECT_TRUE(browser.wait_until("undoButton.title.includes('colours') && !undoButton.disabled && redoButton.disabled"));
  browser.evaluate("undoButton.click()");
  EXPECT_TRUE(browser.wait_until("catena.scene.volumes[0].map == 'viridis' && !redoButton.disabled"));
  EXPECT_TRUE(browser.evaluate("at('steps').hidden").boolean);
  click("record");
  EXPECT_TRUE(browser.wait_until("catena.state.recording.mb > 0 && at('record').textContent == 'Stop'"));
  keep(browser, "recording");
  click("record");
  EXPECT_TRUE(browser.wait_until("document.querySelector('#recorded a')"));
  EXPECT_GT(browser.evaluate("fetch(document.querySelector('#recorded a').href).then(a => a.arrayBuffer()).then(b => b.byteLength)").number,
            100);
  EXPECT_EQ(browser.evaluate("catena.note").string, "");

  EXPECT_EQ(served.interrupt_and_wait(), 0);
  EXPECT_TRUE(browser.wait_until("!document.getElementById('gone').hidden"));
}

/// Not a test but a measurement (docs/user/browser.md): CATENA_SCENE, else the scene above, turned for 5 s by a drag in each of the
/// browser's own frames.
TEST(BrowserClient, DISABLED_LatencyAndRate) {
  if (test::browser_path().empty()) GTEST_SKIP() << "there is no Chromium here";
  const test::TemporaryFolder folder;
  test::write_file(folder / "served.json", kScene);
  const char* scene = std::getenv("CATENA_SCENE");
  test::ServeProcess served(scene != nullptr ? scene : folder / "served.json");
  ASSERT_NE(served.port(), 0) << served.err();
  test::Browser browser("1314,768");
  ASSERT_TRUE(browser.is_running());
  browser.open(served.url());
  ASSERT_TRUE(browser.wait_until("window.catena && catena.exact > 0 && picture.width > 1000"));
  browser.evaluate(
      "(async () => { catena.latencies.length = catena.arrivals.length = 0; catena.bytes = 0; "
      "const send = (what, x) => picture.dispatchEvent(new PointerEvent(what, {clientX: x, clientY: 300, pointerId: 1, button: 0})); "
      "picture.setPointerCapture = () => 0; send('pointerdown', 500); const end = performance.now() + 5000; let n = 0; "
      "while (performance.now() < end) { await new Promise(requestAnimationFrame); send('pointermove', 500 + ++n % 200); } "
      "send('pointerup', 500); return n; })()");
  const std::string count = "catena.latencies.length", ordered = "[...catena.latencies].sort((a, b) => a - b)";
  std::printf("%.0f x %.0f pixels: %.1f pictures a second of %.0f kB; from motion to picture %.0f ms median, %.0f ms of 95 %%\n",
              browser.evaluate_number("picture.width"), browser.evaluate_number("picture.height"),
              browser.evaluate_number("catena.arrivals.length") / 5,
              browser.evaluate_number("catena.bytes / catena.arrivals.length / 1000"),
              browser.evaluate_number(ordered + "[Math.floor(" + count + " / 2)]"),
              browser.evaluate_number(ordered + "[Math.floor(" + count + " * 0.95)]"));
  // A screenshot with the probe in the scene.
  const int x = static_cast<int>(browser.evaluate_number("picture.getBoundingClientRect().width / 2"));
  browser.evaluate("picture.focus()");
  browser.key("r");
  browser.mouse("mouseMoved", x, 280);
  browser.key("h");
  EXPECT_TRUE(browser.wait_until("catena.state.probe"));
  for (int i = 0; i < 8; ++i) browser.mouse("mouseWheel", x, 280, "\"deltaX\": 0, \"deltaY\": -100");
  const double exact = browser.evaluate_number("catena.exact");
  EXPECT_TRUE(browser.wait_until("sent.size == 0 && catena.exact > " + std::to_string(exact)));
  keep(browser, "measured");
  EXPECT_EQ(served.interrupt_and_wait(), 0);
  std::printf("%s", served.out().substr(served.out().find('\n') + 1).c_str());
}

}  // namespace browser_test
