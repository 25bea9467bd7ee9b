// SPDX-License-Identifier: MIT
/// Helpers of all tests: where things are, a folder that vanishes, text files, the shared data folder.
#pragma once
#include <string>

namespace catena::test {

const std::string& source_dir();    ///< of the checkout
const std::string& binary_dir();    ///< of this build
const std::string& program_path();  ///< of `catena` in this build

/// A fresh folder, removed with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

void write_file(const std::string& path, const std::string& text);
std::string read_file(const std::string& path);
bool exists(const std::string& path);

/// A file of the real data beside the checkout (../shared/data), or empty when it is not there: then skip with a message.
std::string shared_data(const std::string& name);

}  // namespace catena::test
