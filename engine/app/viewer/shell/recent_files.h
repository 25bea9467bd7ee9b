/// RecentFiles has the scenes and data files that were opened last, kept from run to run in $XDG_STATE_HOME/catena/recent.json (else
/// ~/.local/state/catena/recent.json): {"files": [PATH, ...]}, the newest first. It never fails the program: where there is no home,
/// nothing can be written or the file is none of ours, the list is empty or stays as it was. Frame thread.
#pragma once
#include <string>
#include <vector>

namespace catena::app {

inline constexpr std::size_t kMaxRecentFiles = 10;

class RecentFiles {
 public:
  /// The user's own list.
  RecentFiles();
  /// The list at another place; empty: it is kept nowhere.
  explicit RecentFiles(std::string path);

  /// Those that are there now, whole paths, the newest first.
  std::vector<std::string> shown() const;
  /// Puts a file at the top and writes the list, which is read again before: other programs add to it as well.
  void add(const std::string& file);
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::vector<std::string> files_;
};

}  // namespace catena::app
