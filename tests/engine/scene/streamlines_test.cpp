// SPDX-License-Identifier: MIT
#include "engine/scene/streamlines.h"

#include <algorithm>

#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::streamlines_test {

/// A scene of a circular flow by formula and a sphere, with one set of streamlines.
std::string scene_text(const std::string& set) {
  return "{\"fields\": {\"swirl\": {\"analytic\": \"circle\"}, \"ball\": {\"analytic\": \"sphere\"}},\n\"streamlines\": [{\"field\": "
         "\"swirl\",\n" +
         set + "}]}";
}

Entity set_of(const Scene& scene) { return entities_of<StreamlineSet>(scene).at(0); }

std::string line_of(int line) { return "s.json:" + std::to_string(line) + ":"; }

void refused(const std::string& set, int line, const std::vector<std::string>& words) {
  expect_error(parse_scene(scene_text(set), "s.json"), line_of(line), words);
}

void no_lines(const std::string& set, int line, const std::vector<std::string>& words) {
  Scene scene = parsed(scene_text(set));
  expect_error(resolve_lines(scene, set_of(scene)), line_of(line), words);
}

std::vector<flow::CurvePtr> lines_of_scene(const std::string& text) {
  Scene scene = parsed(text);
  return value_of(resolve_lines(scene, set_of(scene)));
}

std::vector<flow::CurvePtr> lines_of(const std::string& set) { return lines_of_scene(scene_text(set)); }

/// The lines of an unbounded formula in the box -1..1.
std::vector<flow::CurvePtr> lines_of_formula(const std::string& analytic, const std::string& set) {
  return lines_of_scene("{\"fields\": {\"v\": {\"analytic\": \"" + analytic +
                        "\", \"box\": [-1, 1]}}, \"streamlines\": [{\"field\": \"v\", " + set + "}]}");
}

TEST(SeedPatterns, LinesOfAFormulaEndAtItsBox) {
  for (const char* seeds : {R"("seeds": {"evenly_spaced": {"distance": 0.4}})", R"("seeds": [[0.3, 0.2, 0.1], [-0.4, 0.5, 0.9]])",
                            R"("seeds": {"line": {"from": [0, -0.9, 0], "to": [0, 0.9, 0], "count": 5}})"}) {
    const auto lines = lines_of_formula("abc", seeds);
    EXPECT_GE(lines.size(), 2u) << seeds;
    for (const flow::CurvePtr& line : lines)
      for (const auto& [end, knot] : {std::pair{line->first_end(), line->knots().front()}, {line->last_end(), line->knots().back()}}) {
        // An evenly spaced line may end earlier, at another line.
        EXPECT_LE(max_abs(knot.p), 1 + 1e-8) << seeds;
        if (end == flow::Termination::boundary) {
          EXPECT_NEAR(max_abs(knot.p), 1, 1e-8) << seeds;
        }
      }
  }
  // A seed outside the box does not let the other lines leave the box.
  const auto mixed = lines_of_formula("abc", R"("seeds": [[0.3, 0.2, 0.1], [0, 1.5, 0]])");
  ASSERT_EQ(mixed.size(), 2u);
  EXPECT_LE(max_abs(mixed[0]->knots().back().p), 1 + 1e-8);
  EXPECT_GT(max_abs(mixed[1]->knots().back().p), 2);
  // Lines reach the end of a large box, beyond ten default lengths.
  const auto far = lines_of_scene(
      R"({"fields": {"v": {"analytic": "helix", "box": [-30, 30]}}, "streamlines": [{"field": "v", "seeds": [[1, 0, 0]]}]})");
  EXPECT_NEAR(far.front()->knots().back().p.z, 30, 1e-6);
  // A stated length, or a seed outside the box, applies without the box.
  EXPECT_NEAR(lines_of_formula("uniform", R"("seeds": [[0, 0, 0]], "length": 7)")[0]->knots().back().s, 7, 1e-12);
  EXPECT_NEAR(lines_of_formula("uniform", R"("seeds": [[0, 3, 0]])")[0]->knots().back().s, 40, 1e-9);
}

TEST(SeedPatterns, EvenlySpacedLinesOfAHollowDomainStartInItsWall) {
  const auto lines = lines_of_scene(R"({"fields": {"f": {"analytic": "left-ventricle", "part": "fibre", "box": [-3, 3]}},
      "streamlines": [{"field": "f", "kind": "line", "seeds": {"evenly_spaced": {"distance": 0.3}}}]})");
  EXPECT_GT(lines.size(), 10u);
}

TEST(SeedPatterns, EveryPatternGivesLines) {
  EXPECT_EQ(lines_of(R"("seeds": {"line": {"from": [0.2, 0, 0], "to": [1.2, 0, 0], "count": 6}})").size(), 6u);
  EXPECT_EQ(lines_of(R"("seeds": {"plane": {"origin": [0.2, 0, -1], "u": [1, 0, 0], "v": [0, 0, 2], "count": [3, 4]}})").size(), 12u);
  EXPECT_EQ(lines_of(R"("seeds": {"sphere": {"center": [0.5, 0, 0], "radius": 0.3, "count": 20}})").size(), 20u);
  EXPECT_EQ(lines_of(R"("seeds": {"sphere": {"center": [0.5, 0, 0], "radius": 0.3, "count": 20, "inside": true}})").size(), 20u);
  EXPECT_EQ(lines_of(R"("seeds": {"isosurface": {"field": "ball", "level": 0.8, "count": 15}})").size(), 15u);
  const auto even = lines_of(R"("seeds": {"evenly_spaced": {"distance": 0.5, "start": [[1, 0, 0]], "count": 9}}, "length": 8)");
  EXPECT_GE(even.size(), 4u);
  EXPECT_LE(even.size(), 9u);
}

TEST(SeedPatterns, TracingReportsProgress) {
  std::vector<std::pair<std::size_t, std::size_t>> reports;
  set_trace_progress([&](const std::string& field, std::size_t seeds, std::size_t of) {
    EXPECT_EQ(field, "swirl");
    reports.push_back({seeds, of});
  });
  lines_of(R"("seeds": {"sphere": {"center": [0.5, 0, 0], "radius": 0.3, "count": 200}})");
  set_trace_progress({});
  ASSERT_GE(reports.size(), 3u);
  EXPECT_EQ(reports.back(), std::pair(std::size_t{0}, std::size_t{0})) << "the end";
  reports.pop_back();
  EXPECT_TRUE(std::ranges::is_sorted(reports));
  EXPECT_EQ(reports.back(), std::pair(std::size_t{200}, std::size_t{200}));
}

TEST(SeedPatterns, SeedsOfAnIsosurfaceLieOnIt) {
  for (const auto& line : lines_of(R"("seeds": {"isosurface": {"field": "ball", "level": 0.8, "count": 10}})"))
    for (const flow::Knot& knot : line->knots()) EXPECT_NEAR(norm(knot.p), 0.8, 1e-8);  // circles stay on the sphere
}

TEST(SeedPatterns, SeedsWithoutALineAreLeftOut) {
  // The flow is zero on the axis.
  EXPECT_EQ(lines_of(R"("seeds": {"line": {"from": [-1, 0, 0], "to": [1, 0, 0], "count": 3}})").size(), 2u);
  no_lines(R"("seeds": {"line": {"from": [0, 0, -1], "to": [0, 0, 1], "count": 3}})", 3, {"none of the 3 seeds starts a line", "zero"});
  no_lines(R"("seeds": {"evenly_spaced": {"distance": 0.5, "start": [[0, 0, 0]]}})", 3, {"inside the flow was expected"});
  no_lines(R"("seeds": {"isosurface": {"field": "swirl", "level": 0.8, "count": 10}})", 3, {"vector field", "expected"});
  no_lines(R"("seeds": {"isosurface": {"field": "ball", "level": -3, "count": 10}})", 3, {"level -3", "expected"});
  no_lines("\"seeds\": {\"evenly_spaced\": {\n\"distance\": 1e-6}}", 4, {"\"distance\" is 1e-06", "0.004"});
  no_lines("\"seeds\": [[1, 0, 0],\n[0, 0, 0]]", 4, {"zero at the seed"});
}

TEST(SeedPatterns, LinesShareTheCurvesOfHapticLinks) {
  Scene scene = parsed(scene_text("\"seeds\": [[1, 0, 0], [0.5, 0, 0]]"));
  const auto lines = value_of(resolve_lines(scene, set_of(scene)));
  const auto any = resolve_field(scene, "swirl", {});
  const auto link_curve = value_of(resolve_streamline(scene, {any->vector.get()}, {0.5, 0, 0}, {}));
  EXPECT_EQ(lines.at(1).get(), link_curve.get());
  EXPECT_EQ(resolve_lines(scene, set_of(scene))->at(0).get(), lines[0].get());
}

TEST(SeedPatterns, ErrorsNameTheLine) {
  refused("\"seeds\": {\"ring\": {}}", 3, {"ring", "evenly_spaced"});
  refused("\"seeds\": {}", 3, {"0 patterns", "line, plane, sphere, isosurface, evenly_spaced"});
  refused("\"seeds\": {\"line\": {\"from\": [0, 0, 0], \"to\": [1, 0, 0], \"count\": 2},\n\"sphere\": {}}", 3, {"2 patterns"});
  refused("\"seeds\": {\"line\": {\"from\": [0, 0, 0],\n\"to\": [1, 0]}}", 4, {"\"to\"", "three finite numbers"});
  refused("\"seeds\": {\"line\": {\"from\": [0, 0, 0], \"to\": [1, 0, 0]}}", 3, {"\"count\" is missing"});
  refused("\"seeds\": {\"line\": {\"from\": [0, 0, 0], \"to\": [1, 0, 0],\n\"count\": 0}}", 4, {"\"count\"", "expected"});
  refused("\"seeds\": {\"line\": {\"from\": [0, 0, 0], \"to\": [1, 0, 0], \"number\": 2}}", 3, {"number", "count"});
  refused("\"seeds\": {\"plane\": {\"origin\": [0, 0, 0], \"u\": [1, 0, 0], \"v\": [0, 1, 0], \"count\": 5}}", 3, {"[along u, along v]"});
  refused("\"seeds\": {\"plane\": {\"origin\": [0, 0, 0], \"u\": [1, 0, 0], \"v\": [0, 1, 0], \"count\": [2, 1.5]}}", 3, {"whole numbers"});
  refused("\"seeds\": {\"sphere\": {\"center\": [0, 0, 0], \"radius\": 0, \"count\": 5}}", 3, {"\"radius\" is 0", "> 0"});
  refused("\"seeds\": {\"isosurface\": {\"field\": \"bal\", \"level\": 1, \"count\": 5}}", 3, {"unknown field \"bal\"", "ball"});
  refused("\"seeds\": {\"evenly_spaced\": {\"distance\": 0}}", 3, {"\"distance\" is 0"});
  refused("\"seeds\": {\"evenly_spaced\": {\"distance\": 1, \"termination_ratio\": 1.5}}", 3,
          {"\"termination_ratio\" is 1.5", "from 0 to 1"});
  refused("\"seeds\": {\"evenly_spaced\": {\"distance\": 1, \"start\": []}}", 3, {"\"start\"", "at least one"});
  refused("\"seeds\": {\"line\": 3}", 3, {"object", "expected"});
  refused("\"seeds\": [[1, 0, 0]], \"tolerance\": 0.5", 3, {"\"tolerance\" is 0.5", "from 0 to 0.01"});
  refused("\"seeds\": [[1, 0, 0]], \"arrows\": -1", 3, {"\"arrows\" is -1", "> 0"});
}

TEST(ColoredLines, TheKeysAreChecked) {
  refused("\"seeds\": [[1, 0, 0]], \"color\": [[0, 1, 1, 1]]", 3, {"table", "\"color_by\""});
  refused("\"seeds\": [[1, 0, 0]], \"color_by\": {\"field\": \"sped\"}", 3, {"\"sped\"", "ball"});
  refused("\"seeds\": [[1, 0, 0]], \"color_by\": {\"quantity\": \"speed\", \"color\": [1, 0, 0]}", 3, {"\"color\""});
  refused("\"seeds\": [[1, 0, 0]], \"color_by\": {\"quantity\": \"speed\",\n\"color\": [[0, 1, 1, 1],\n[0, 1, 0, 1]]}", 5,
          {"strictly rising"});
  const auto set = only<StreamlineSet>(
      parsed(scene_text("\"seeds\": [[1, 0, 0]], \"color_by\": {\"field\": \"ball\", \"color\": [[0, 0, 0, 1], [2, 1, 0, 0]]}")));
  ASSERT_TRUE(set.color_by);
  EXPECT_EQ(set.color_by->source, ColorBy::Source::field);
  EXPECT_EQ(set.color_by->colors.size(), 2u);
}

TEST(ColoredLines, TheIndicatorIsChecked) {
  const auto read = [](const std::string& body) {
    return parse_scene("{\"fields\": {\"swirl\": {\"analytic\": \"circle\"}},\n\"indicator\": {" + body + "}}", "s.json");
  };
  EXPECT_TRUE(read("\"field\": \"swirl\", \"length\": 0.3"));
  expect_error(read("\"field\": \"whirl\""), line_of(2), {"unknown field", "swirl"});
  expect_error(read("\"field\": \"swirl\", \"length\": 0"), line_of(2), {"> 0"});
  expect_error(read("\"feld\": \"swirl\""), line_of(2), {"feld", "field"});
}

TEST(Lines, VisitedLinesEqualResolvedLinesAndAreCachedIfFew) {
  const std::string seeds = R"("seeds": {"line": {"from": [0.5, 0, 0], "to": [1, 0, 0], "count": 300}})";
  Scene all = parsed(scene_text(seeds)), scene = parsed(scene_text(seeds));
  const auto lines = value_of(resolve_lines(all, set_of(all)));
  const Entity set = set_of(scene);
  EXPECT_EQ(lines_version(scene, set), 0u) << "not made";
  for (const std::size_t knot_limit : {std::size_t(1000), kMaxCachedKnots}) {
    std::size_t visited = 0, blocks = 0;
    std::weak_ptr<const flow::Curve> one;
    ASSERT_TRUE(visit_lines(
        scene, set,
        [&](const LineBlock& block) -> Outcome {
          EXPECT_EQ(block.seeds_total, 300u);
          for (const flow::CurvePtr& curve : block.curves) {
            const std::vector<flow::Knot>&a = curve->knots(), &b = lines.at(visited)->knots();
            EXPECT_EQ(a.size(), b.size());
            EXPECT_EQ(a.back().p, b.back().p);
            ++visited;
          }
          EXPECT_EQ(block.seeds_done, visited);
          one = block.curves.front();
          ++blocks;
          return Done{};
        },
        knot_limit));
    EXPECT_EQ(visited, 300u);
    EXPECT_GT(blocks, 1u);
    EXPECT_EQ(one.expired(), knot_limit < kMaxCachedKnots) << "nobody else holds them";
    EXPECT_NE(lines_version(scene, set), 0u);
    EXPECT_EQ(lines_bounds(scene, set).hi, lines_bounds(all, set_of(all)).hi);
  }
  const std::uint64_t version = lines_version(scene, set);
  ASSERT_TRUE(resolve_lines(scene, set));
  EXPECT_EQ(lines_version(scene, set), version) << "they were kept";
}

TEST(Lines, TooManyKnotsAreAnErrorAndProgressIsReported) {
  Scene scene = parsed(scene_text(R"("seeds": [[1, 0, 0]])"));
  const json::Node node = value_of(json::parse(R"({"line": {"from": [0.5, 0, 0], "to": [1, 0, 0], "count": 300}})", "seeds.json"));
  const auto seeds = value_of(read_seeds(scene, node));
  const auto field = resolve_field(scene, only<StreamlineSet>(scene).field, {});
  ASSERT_TRUE(field && field->vector);
  LineRequest request{flow::Flow{field->vector.get()}};
  std::vector<std::size_t> done;
  request.progress = [&](std::size_t seeds_done, std::size_t of) {
    EXPECT_EQ(of, 300u);
    done.push_back(seeds_done);
  };
  EXPECT_EQ(value_of(trace_lines(scene, seeds, request, node)).size(), 300u);
  ASSERT_GE(done.size(), 2u);
  EXPECT_EQ(done.back(), 300u);
  request.max_knots = 1000;
  expect_error(trace_lines(scene, seeds, request, node), "", {"of the 300 seeds have more than 1000 knots in total"});
}

}  // namespace catena::scene::streamlines_test
