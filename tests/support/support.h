// SPDX-License-Identifier: MIT
/// Helpers of all tests: paths, a temporary folder, text files, the shared data folder.
#pragma once
#include <string>

namespace catena::test {

const std::string& source_dir();    ///< root of the checkout
const std::string& binary_dir();    ///< build folder
const std::string& program_path();  ///< path of `catena` in this build

/// A new folder, removed with its contents on destruction.
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

/// Path of a real data file beside the checkout (../shared/data); empty if it does not exist: then the test is skipped.
std::string shared_data(const std::string& name);

}  // namespace catena::test
