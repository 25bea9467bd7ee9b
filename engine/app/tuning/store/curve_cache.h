// SPDX-License-Identifier: MIT
/// Cache of measured curves, so that the next run tunes without measuring: one file per key in $XDG_CACHE_HOME/catena/plans (else
/// ~/.cache/catena/plans). Each file is a report of `catena tradeoff` (tradeoff/report), which can make a page of it. All files can be
/// deleted at any time. A file that is damaged, foreign or of another key is rejected with one message; the settings of its points are
/// looked up among those that this program offers (image_tuning.h, tick_tuning.h). Files are written atomically; if nothing can be written,
/// nothing is cached. Any thread.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/app/tuning/measure/curve.h"
#include "engine/base/hash.h"
#include "engine/scene/scene.h"

namespace catena::app::tuning {

using tuning::Curve;

/// Key of cached curves, a hash of 16 hexadecimal digits: the system (processor, cores, rendering threads), the build of this program, and
/// everything that is added.
class CurveKey {
 public:
  /// `sense`: "eye" for image curves, "hand" for tick curves.
  explicit CurveKey(std::string_view sense);
  CurveKey& add(std::string_view words);
  CurveKey& add(double number);
  /// Adds the scene's text except its targets ("quality"; "max_proxy_error" and "max_tick_us" of "coupling"), its time step, and the files
  /// that it refers to: name, size, modification time, and the first and last 64 KiB; for a folder, the same of the files in it.
  CurveKey& add(const scene::Scene& scene, std::string_view text);
  /// Returns the 16 hexadecimal digits.
  std::string text() const;

 private:
  void add_file(const std::string& path);
  Fnv1a hash_;
};

/// Reads and writes the files of cached curves.
class CurveCache {
 public:
  /// Uses the user's own cache folder; if there is no home folder, nothing is cached.
  CurveCache();
  explicit CurveCache(std::string folder) : folder_(std::move(folder)) {}

  /// Returns the curves cached under the key if the file is valid and `fits` accepts them; else nothing. `message` receives a message if a
  /// file exists but is rejected.
  std::optional<std::vector<Curve>> find(const std::string& key, const std::function<bool(const std::vector<Curve>&)>& fits,
                                         std::string& message) const;
  /// Writes the curves under the key; `source` names the scene. An Error if they cannot be written.
  Outcome store(const std::string& key, const std::string& source, const std::vector<Curve>& curves) const;
  /// Returns the path of the key's file; empty if nothing is cached.
  std::string path_of(const std::string& key) const { return folder_.empty() ? std::string() : folder_ + "/" + key + ".json"; }

 private:
  std::string folder_;
};

}  // namespace catena::app::tuning
