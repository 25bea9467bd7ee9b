/// Where measured curves are kept from run to run, so that a plan is made at once the next time: one file a key in
/// $XDG_CACHE_HOME/catena/plans (else ~/.cache/catena/plans). Each is a report of `catena tradeoff` (tradeoff/report), which makes a page
/// of it, too. All of it can be deleted at any time. A file that is damaged, is none of ours or belongs to another key is said in one
/// sentence and never believed: what its points stand for is looked up among the settings that this program offers (eye_plan.h,
/// hand_plan.h). Files are written whole or not at all; where nothing can be written, nothing is kept. Any thread.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/app/tuning/tradeoff/measure/curve.h"
#include "engine/scene/scene.h"

namespace catena::app::plan {

using tradeoff::Curve;

/// What determines curves, as a hash of 16 digits: the machine (processor, cores, threads that draw), the build of this program, and what
/// is added.
class CurveKey {
 public:
  /// `sense`: eye or hand.
  explicit CurveKey(std::string_view sense);
  CurveKey& add(std::string_view words);
  CurveKey& add(double number);
  /// The scene's text but for what is wanted of it ("plan", "quality"), its step in time, and the files that it names: their names, sizes,
  /// times of change, and the bytes at their ends; of a folder those of what lies in it.
  CurveKey& add(const scene::Scene& scene, std::string_view text);
  std::string text() const;

 private:
  void add_file(const std::string& path);
  std::uint64_t hash_;
};

class CurveCache {
 public:
  /// The user's own folder; empty where there is no home: nothing is kept.
  CurveCache();
  explicit CurveCache(std::string folder) : folder_(std::move(folder)) {}

  /// What is kept under the key, if `fits` says that this program can use it. `told`: gets the sentence where a file is there and is not
  /// believed.
  std::optional<std::vector<Curve>> find(const std::string& key, const std::function<bool(const std::vector<Curve>&)>& fits,
                                         std::string& told) const;
  /// An error says why it could not be kept.
  Outcome store(const std::string& key, const std::string& source, const std::vector<Curve>& curves) const;
  std::string path_of(const std::string& key) const { return folder_.empty() ? std::string() : folder_ + "/" + key + ".json"; }

 private:
  std::string folder_;
};

}  // namespace catena::app::plan
