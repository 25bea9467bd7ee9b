// SPDX-License-Identifier: MIT
/// Runs of `catena` on files of a temporary folder. In a command line, "{a.vdb}" is the file a.vdb of that folder.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "render/image/image.h"
#include "tests/engine/app/program_runs.h"

namespace catena::test {

/// The words of a command line; "{NAME}" becomes the path of the file NAME in the folder, and "{}" that of the folder.
inline Words words_of(const TemporaryFolder& folder, const std::string& line) {
  Words words;
  std::istringstream in(line);
  for (std::string word; in >> word;) {
    const auto open = word.find('{'), close = word.find('}');
    if (open != std::string::npos && close != std::string::npos) {
      const std::string name = word.substr(open + 1, close - open - 1);
      word = word.substr(0, open) + (name.empty() ? folder.path() : folder / name) + word.substr(close + 1);
    }
    words.push_back(word);
  }
  return words;
}

inline void expect_parts(const std::string& text, const Words& parts) {
  for (const std::string& part : parts) EXPECT_TRUE(has(text, part));
}

inline void expect_one_line(const std::string& err) {
  EXPECT_TRUE(is_one_line(err));
  EXPECT_TRUE(err.starts_with("catena: ")) << err;
}

class ProgramInFolder : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const { write_file(folder_ / name, text); }
  std::string read(const std::string& name) const { return read_file(folder_ / name); }
  bool exists(const std::string& name) const { return test::exists(folder_ / name); }
  int files() const { return int(std::distance(std::filesystem::directory_iterator(folder_.path()), {})); }
  /// Runs the command line; `more` are further words, for texts with spaces.
  ProgramResult run(const std::string& line, const Words& more = {}) const { return run_catena(joined(words_of(folder_, line), more)); }
  ProgramResult succeed(const std::string& line, const Words& more = {}) const { return run_ok(words_of(folder_, line), more); }
  /// Expects exit code 2, one line with the parts on stderr, and no new file in the folder.
  ProgramResult expect_refused(const std::string& line, const Words& parts, const Words& more = {}) const {
    SCOPED_TRACE(line);
    const int before = files();
    const ProgramResult done = run(line, more);
    // A full disk is an error of the machine: exit code 1.
    EXPECT_EQ(done.exit_code, done.err.find("No space left on device") != std::string::npos ? 1 : 2) << done.err;
    expect_one_line(done.err);
    expect_parts(done.err, parts);
    EXPECT_EQ(files(), before) << "nothing is left behind";
    return done;
  }
  render::Image8 picture(const std::string& name) const {
    auto image = render::read_png(folder_ / name);
    EXPECT_TRUE(image) << image.error().message;
    return image ? std::move(*image) : render::Image8();
  }
  /// The image o.png of `catena render` with the line, without a message of the validation layers.
  render::Image8 drawn(const std::string& line, const Words& more = {}, std::string* err = nullptr) const {
    const ProgramResult done = succeed("render -o {o.png} --validation --stats {o.json} " + line, more);
    expect_parts(read("o.json"), {"\"validation_messages\": 0"});
    if (err != nullptr) *err = done.err;
    return picture("o.png");
  }
  TemporaryFolder folder_;
};

}  // namespace catena::test
