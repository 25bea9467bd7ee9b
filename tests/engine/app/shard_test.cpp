// SPDX-License-Identifier: MIT
/// `--shard I/N` of render, trace, tradeoff and study, and `merge`: the parts together have the bytes of one process; a part that is
/// missing, truncated or of another run is refused.
#include "engine/app/batch/shard.h"

#include "tests/engine/app/program_in_folder.h"

namespace catena::shard_test {

namespace fs = std::filesystem;

const std::string kLine = R"({"line": {"from": [0.25, 0, 0], "to": [5, 0, 0], "count": 20}})";

class Shards : public test::ProgramInFolder {
 protected:
  void SetUp() override {
    write("s.json", R"({"fields": {"v": {"analytic": "circle"}, "f": {"analytic": "sphere", "resolution": 24}}, "volumes": [{"field": "f"}],
      "streamlines": [{"field": "v", "seeds": [[1, 0, 0]]}],
      "chain": [{"name": "skin", "type": "isosurface", "field": "f", "level": 1}]})");
    write("seeds.csv", "x,y,z\n0.5,0,0\n1,0.5,0.25\n0.25,0,0\n0,2,0\n0.1,0.1,0.1\n0.7,0,-1\n0.7,0,1\n");
  }
  /// Runs the command line for each of three shards, in an order other than theirs.
  void run_shards(const std::string& line, const test::Words& more = {}) const {
    for (const char* shard : {"3/3", "1/3", "2/3"}) succeed(line + " --shard " + shard, more);
  }
  /// Expects that both folders have the same files with the same bytes, except recordings, which state when they were made; returns their
  /// number.
  int expect_equal_folders(const std::string& a, const std::string& b) const {
    int count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / a)) {
      const std::string name = fs::relative(entry.path(), folder_ / a).string();
      if (!entry.is_regular_file()) continue;
      EXPECT_TRUE(exists(b + "/" + name) && (name.ends_with(".catlog") || read(a + "/" + name) == read(b + "/" + name))) << name;
      ++count;
    }
    return count;
  }
};

TEST(Shard, EachItemBelongsToOneShard) {
  for (const std::size_t total : {0, 1, 7, 12})
    for (const std::size_t count : {1, 3, 20}) {
      std::vector<std::size_t> all;
      for (std::size_t index = 1; index <= count; ++index)
        for (const std::size_t item : app::Shard{index, count}.items(total)) {
          EXPECT_TRUE((app::Shard{index, count}).has(item));
          all.push_back(item);
        }
      std::ranges::sort(all);
      ASSERT_EQ(all.size(), total);
      for (std::size_t item = 0; item < total; ++item) EXPECT_EQ(all[item], item);
    }
}

TEST(Shard, NamesAndWords) {
  EXPECT_EQ(app::part_path("out/a.b.csv", {2, 4}), "out/a.b.shard-2-of-4.csv");
  EXPECT_EQ(app::shard_of_part("out/a.b.csv", "a.b.shard-2-of-4.csv"), (app::Shard{2, 4}));
  for (const char* other : {"a.b.csv", "a.b.shard-2-of-4.vtp", "a.b.shard-5-of-4.csv", "a.b.shard-02-of-4.csv", "c.b.shard-2-of-4.csv"})
    EXPECT_FALSE(app::shard_of_part("out/a.b.csv", other)) << other;
  for (const char* wrong : {"", "1", "0/3", "4/3", "1/3/3", " 1/3", "+1/3", "1/0", "1/1000000", "one/3"})
    EXPECT_FALSE(app::parse_shard(std::string(wrong))) << wrong;
}

TEST_F(Shards, ImagesEqualThoseOfOneProcess) {
  fs::create_directories(folder_ / "whole");
  fs::create_directories(folder_ / "parts");
  const std::string options = "render {s.json} --size 48x32 --frames 4 --orbit 90 --elevation 20 --view +x ";
  succeed(options + "-o {whole/%02d.png} --depth {whole/z%d.exr}");
  run_shards(options + "-o {parts/%02d.png} --depth {parts/z%d.exr}");
  EXPECT_EQ(expect_equal_folders("whole", "parts"), 8);
  test::expect_parts(succeed(options + "-o {parts/%02d.png} --shard 5/8").out, {"shard 5/8 has none of the 4 images"});
  expect_refused(options + "-o {a.png} --shard 1/2", {"a.png: --shard divides", "%03d"});
  expect_refused(options + "-o {%03d.png} --shard 1/2 --quality time=20", {"time=20 is chosen by the time of this machine", "error=E"});
  expect_refused(options + "-o {%03d.png} --shard 3/2", {"--shard \"3/2\": I/N was expected"});
}

TEST_F(Shards, TracedLinesEqualThoseOfOneProcess) {
  for (const std::string& seeds : {folder_ / "seeds.csv", kLine}) {
    for (const std::string tolerance : {"", "--tolerance 1e-5 "}) {
      const std::string options = "trace {s.json} --field v --length 3 " + tolerance;
      succeed(options + "-o {whole.csv}", {"--seeds", seeds});
      run_shards(options + "-o {lines.csv} --stats {stats.json}", {"--seeds", seeds});
      succeed("merge {lines.csv}");
      EXPECT_GT(read("whole.csv").size(), 1000u);
      EXPECT_TRUE(read("whole.csv") == read("lines.csv")) << seeds << tolerance;
    }
  }
  EXPECT_TRUE(exists("stats.shard-2-of-3.json"));
  expect_refused("trace {s.json} --field v --seeds {seeds.csv} -o {a.vtp} --shard 1/2", {"a.vtp: with --shard", ".csv"});
  expect_refused("trace {s.json} --field v -o {a.csv} --shard 1/2", {"evenly spaced lines depend on each other"},
                 {"--seeds", R"({"evenly_spaced": {"distance": 0.5}})"});
}

TEST_F(Shards, PartsAreChecked) {
  const std::string options = "trace {s.json} --field v --length 3 --seeds {seeds.csv} -o {lines.csv}";
  expect_refused("merge {lines.csv}", {"there are no parts", "lines.shard-1-of-4.csv"});
  run_shards(options);
  const std::string part = read("lines.shard-2-of-3.csv");
  const auto refused = [&](const std::string& expected) {
    expect_refused("merge {lines.csv}", {expected});
    EXPECT_FALSE(exists("lines.csv"));
    write("lines.shard-2-of-3.csv", part);
  };
  fs::remove(folder_ / "lines.shard-2-of-3.csv");
  refused("lines.csv: shard 2/3 is missing");
  for (const std::size_t size : {std::size_t(0), part.size() / 2, part.size() - 1}) {
    write("lines.shard-2-of-3.csv", part.substr(0, size));
    refused("lines.shard-2-of-3.csv: is truncated or was changed");
  }
  std::string changed = part;
  changed[part.size() / 3] ^= 1;
  write("lines.shard-2-of-3.csv", changed);
  refused("is truncated or was changed");
  write("lines.shard-2-of-3.csv", read("lines.shard-1-of-3.csv"));
  refused("is truncated or was changed");
  succeed("trace {s.json} --field v --length 4 --seeds {seeds.csv} -o {lines.csv} --shard 2/3");
  refused("of other inputs, other options or another version");
  write("lines.shard-2-of-3.csv", part);
  succeed(options + " --shard 1/2");
  refused("parts of 2 shards and of 3");
}

TEST_F(Shards, MeasuredErrorsEqualThoseOfOneProcess) {
  const std::string options = "tradeoff {s.json} --effort quick ";
  const test::Words only{"--only", "interpolation,values,isosurface,servo rate"};
  succeed(options + "-o {whole}", only);
  run_shards(options + "-o {parts}", only);
  succeed("merge {parts}");
  const auto skipped = [&](const std::string& folder) {
    const std::string text = read(folder + "/tradeoff.json");
    return text.substr(text.find("\"left_out\""), text.find("\"curves\"") - text.find("\"left_out\""));
  };
  EXPECT_EQ(skipped("whole"), skipped("parts"));
  int tables = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "whole")) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(exists("parts/" + name)) << name;
    if (!name.ends_with(".csv")) continue;
    const auto a = test::Table::read(folder_ / ("whole/" + name)), b = test::Table::read(folder_ / ("parts/" + name));
    ASSERT_EQ(a.rows(), b.rows());
    for (std::size_t row = 0; row < a.rows(); ++row)
      for (const char* column : {"setting", "series", "error", "work", "bytes"})
        EXPECT_EQ(a.text(row, column), b.text(row, column)) << name;
    ++tables;
  }
  EXPECT_GT(tables, 0);
  expect_refused("tradeoff {parts/tradeoff.json} -o {b} --shard 1/2", {"is a report"});
  expect_refused("tradeoff --figure 2 -o {b} --shard 1/2", {"a figure is made by one process"});
}

TEST_F(Shards, SimulatedTrialsEqualThoseOfOneProcess) {
  std::string study = test::read_file(test::source_dir() + "/assets/studies/proxy-chain.json");
  study.replace(study.find("\"trials\": 10"), 12, "\"trials\": 1");
  write("study.json", study);
  const std::string options = "study simulate {study.json} --subjects 2 --record -o ";
  succeed(options + "{whole}");
  for (const char* shard : {"1", "2", "3"}) succeed(options + "{part" + shard + "} --shard " + shard + "/3");
  succeed("study merge {part3} {part1} {part2} -o {merged}");
  EXPECT_GT(expect_equal_folders("whole", "merged"), 5);
  expect_refused("study merge {part1} {part2} -o {never}", {"shard 3/3 is in none of the folders"});
  expect_refused("merge {part1}", {"catena study merge was expected"});
  const std::string rows = read("part2/subjects/002.csv");
  write("part2/subjects/002.csv", rows.substr(0, rows.rfind('\n', rows.size() - 2) + 1));
  expect_refused("study merge {part1} {part2} {part3} -o {never}", {"subject 2 has", "shard 2/3 was expected to be finished"});
}

}  // namespace catena::shard_test
