/// Following a program that still writes: steps in time that are added to a pattern, or to a file of steps, while a scene shows them. A
/// step counts once it can be read whole and none of its files has changed for a second; until then it is waited for.
///   frame thread   follow_steps, followed, apply_steps
///   any thread     poll_steps, on a copy of its own
#pragma once
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace catena::scene {

/// One field, mesh, set of curves or of points that is followed: what it is read from, and its steps so far.
struct FollowedSource {
  enum class Kind { field, mesh, curves, points };
  Kind kind = Kind::field;
  std::string name;                 ///< in the scene
  std::string pattern;              ///< of a pattern
  std::vector<std::string> series;  ///< its files, in order
  field::LoadRequest request;       ///< of a field, at any step; of the others its path
  std::vector<double> times;        ///< of the steps within one file
};

/// From now on the scene's parts that have steps in time are followed. The newest of several steps is held back, since it may be half
/// written. False: nothing in the scene can get steps.
bool start_following(Scene& scene);
/// What is followed of a scene.
std::vector<FollowedSource> followed_sources(const Scene& scene);
/// Looks at the disk: whole steps are added. Reads what is new, and keeps fields (engine/io/field_cache.h). True: there are more.
bool poll_steps(FollowedSource& one);
/// What was found goes into the scene, where it still has the same parts. True: something has more steps.
bool apply_steps(Scene& scene, const std::vector<FollowedSource>& found);

/// What is followed where a data file, or several of a series, are named: a pattern for all files that may come ("wake_*.vtu" of
/// "wake_007.vtu"), or the file itself where steps are added to it. Error: neither can be.
Result<std::string> find_followable_path(const std::string& path);
/// Whether a file that cannot be read may be one that is being written: it has changed within ten seconds, or none of a pattern's
/// files is there yet.
bool may_be_incomplete(const std::string& path);

}  // namespace catena::scene
