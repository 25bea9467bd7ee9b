// SPDX-License-Identifier: MIT
/// Following a running simulation: time steps that are added to a file pattern, or to a file with steps, while a scene shows them. A step
/// is added when it can be read completely and none of its files has changed for a second; until then it is polled.
///   frame thread   start_following, followed_sources, apply_steps
///   any thread     poll_steps, on its own copy of a source
#pragma once
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace catena::scene {

/// A field, mesh, curve set or point set that is followed: its files and the steps known so far.
struct FollowedSource {
  enum class Kind { field, mesh, curves, points };
  Kind kind = Kind::field;
  std::string name;                 ///< Name in the scene
  std::string pattern;              ///< File pattern; empty: one file with steps
  std::vector<std::string> series;  ///< Known files of the pattern, in order
  field::LoadRequest request;       ///< Request that loads a field, at any step; for the other kinds only its path is used
  std::vector<double> times;        ///< Known times of the steps within one file
};

/// Starts following: marks the sources of the scene to which steps can be added. The newest of several steps is held back, since it may
/// be incomplete. Returns false if no source can get further steps.
bool start_following(Scene& scene);
/// Returns the sources of the scene that are followed and loaded.
std::vector<FollowedSource> followed_sources(const Scene& scene);
/// Polls the disk and adds the complete new steps to `source`. Reads new steps, and caches fields (engine/io/field_cache.h). Returns
/// whether there are new steps.
bool poll_steps(FollowedSource& source);
/// Applies polled steps to the sources that still have the same name and files. Returns whether the scene has more steps.
bool apply_steps(Scene& scene, const std::vector<FollowedSource>& found);

/// Returns the path to follow for a data file or for several of a series: a pattern that matches all future files ("wake_*.vtu" for
/// "wake_007.vtu"), or the file itself if steps are added to it. Error: the file does not exist, or can have no further steps.
Result<std::string> find_followable_path(const std::string& path);
/// Returns whether an unreadable file may be one that is being written: it has changed within ten seconds, or no file matches the pattern
/// yet.
bool may_be_incomplete(const std::string& path);

}  // namespace catena::scene
