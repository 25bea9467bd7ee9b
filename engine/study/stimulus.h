// SPDX-License-Identifier: MIT
/// The stimulus of a trial: start, path and target, found in the trial's vector field under the rules of the paper's section 7.1.
/// The rules (StimulusRules):
///   global lines   `context_streamlines` streamlines through points sampled at random in the field's box
///   start          sampled at random in the central fraction `region` of the box (2D: of the image plane); at least `clearance_mm` from
///                  every global line
///   path           the streamline from the start, downstream; it has the same length in all trials
///   curvature      radius of curvature of at least `min_curvature_radius_mm`, which keeps the path away from critical points; the tangent
///                  turns by at least `turn_deg`
///   2D             the path lies in the image plane
///   3D             the path's length projected onto the image plane is at least the fraction `parallel` of its length; of the valid
///                  starts, the one whose path is least occluded by global lines is taken
///   circle         advection target: centered at the start, through the path's end; the path does not reach it earlier
///   plane          advection target: horizontal, through the path's end, below all earlier points of the path
/// The path meets the circle or the plane at an angle of at least `crossing_deg`. Where a field has no valid start among `candidates`, the
/// field of the next seed is tried. Results are bit-identical on one type of machine. Not for the haptic thread; otherwise any thread.
#pragma once
#include <memory>
#include <vector>

#include "engine/base/export.h"
#include "engine/geometry/flow/curve.h"
#include "engine/study/study.h"

namespace catena::study {

/// The geometry of one trial. Positions and lengths in world units.
struct Stimulus {
  int seed = 0;  ///< Seed of the field: the trial's, or the first seed derived from it whose field has a valid start
  Vec3 start{0.0}, middle{0.0}, end{0.0};  ///< First point of the path, point at half of its length, last point
  std::vector<Vec3> path;                  ///< kPathPoints points evenly spaced by arc length, from start to end
  double length = 0;                       ///< Length of the path
  double radius = 0;                       ///< Radius of the circle target: distance from start to end
  double occluded_share = 0;               ///< 3D: fraction of the path that global lines occlude, 0 to 1; 0 in 2D
  std::vector<Vec3> context_points;        ///< Seed point of each global line
  double context_length = 0;               ///< Maximum length of a global line from its seed point, in each direction
};

/// Number of points of Stimulus::path.
inline constexpr int kPathPoints = 513;

/// Generates stimuli one at a time, and caches the last field of every task, so that a field that does not depend on the seed is loaded
/// only for the first stimulus. Not thread-safe: one object per thread.
class CATENA_EXPORT StimulusGenerator {
 public:
  /// `study` must outlive this object.
  explicit StimulusGenerator(const Study& study) : study_(study), field_cache_(study.tasks.size()) {}
  /// Returns the stimulus of task `task` (index into Study::tasks) for `seed`. Error: the field cannot be read, is not a vector field, a
  /// length of the task is more than 100 times the diagonal of the field's box, or no field of up to 200 seeds has a valid start.
  Result<Stimulus> generate(int task, int seed);

 private:
  struct CachedField {
    std::string text;
    field::AnyField field;
  };
  Result<field::AnyField> load_field(int task, int seed);

  const Study& study_;
  std::vector<CachedField> field_cache_;
};

}  // namespace catena::study
