/// The places of a trial, found in its field under the paper's rules (section 7.1):
///   global lines   `lines` streamlines through places drawn in the field's box
///   start          drawn in the middle `region` of the box (2D: of the picture plane); at least `clearance` from every global line
///   path           the streamline from there, downstream; its length is the same in all trials
///   bends          of radius `bend` at least: it keeps away from critical points
///   2D             the path lies in the picture plane
///   3D             at least `parallel` of its length is seen in the picture plane; of the starts that are allowed the one whose path is
///                  hidden least by global lines
///   circle         of advection: about the start, through the path's end; the path does not meet it before
///   plane          of advection: level, through the path's end, below all of the path before
/// and meets either at `crossing` or steeper. Where a field has no such start among `candidates`, that of another seed is asked.
/// The same bits on one type of machine. Off the tick; any thread.
#pragma once
#include <memory>
#include <vector>

#include "engine/geometry/flow/curve.h"
#include "engine/study/study.h"

namespace catena::study {

/// The places of one trial. World units.
struct Stimulus {
  int seed = 0;                            ///< of the field: the trial's, or the first of those that follow from it whose field has a start
  Vec3 start{0.0}, middle{0.0}, end{0.0};  ///< world, of the path
  std::vector<Vec3> path;                  ///< evenly by length, from start to end
  double length = 0;                       ///< of the path, world
  double radius = 0;                       ///< circle: world
  double occluded_share = 0;               ///< share of the path behind a global line, 3D
  std::vector<Vec3> context_points;        ///< a place of each global line
  double context_length = 0;               ///< world, each way
};

/// Corners of Stimulus::path.
inline constexpr int kPathPoints = 513;

/// Makes stimuli one after the other; a field that does not depend on the seed is read once. One thread, each its own.
class StimulusGenerator {
 public:
  /// `study` outlives it.
  explicit StimulusGenerator(const Study& study) : study_(study), field_cache_(study.tasks.size()) {}
  /// An error where the field cannot be read, or none of many seeds gives a start.
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
