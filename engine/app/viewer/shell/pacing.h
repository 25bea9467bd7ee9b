/// Pacing says which picture a window shows next: one that comes in time while something moves, better ones while nothing does. It is pure
/// logic, without window and clock.
///   moves:  the best setting whose expected time fits the budget (time=MS: MS, else kBudgetMs); where even the cheapest takes
///           longer, fewer pixels
///   still:  time=MS: quarter -> half -> every pixel; error=E: the same until a picture's estimated error is at most E;
///           draft, balanced, reference, step=VOXELS: that setting at once
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "engine/app/render/quality_words.h"
#include "render/quality/refinement.h"

namespace catena::app {

inline constexpr double kBudgetMs = 50;
inline constexpr std::uint32_t kMaxScale = 4;

/// What the scene asks of the rays.
struct SceneKind {
  bool rays = true;  ///< something is drawn by rays: settings matter
  bool fast = true;  ///< Renderer::draws_fast
  bool shaded = false;
  bool operator==(const SceneKind&) const = default;
};

struct NextPicture {
  render::RenderSettings settings;
  std::uint32_t scale = 1;  ///< every so many pixels, each way
};

class Pacing {
 public:
  explicit Pacing(const Quality& quality);
  /// The picture after a change.
  NextPicture moving(const SceneKind& kind);
  /// The picture after the last, with nothing changed; nothing: it was the last.
  std::optional<NextPicture> still(const SceneKind& kind);
  /// The picture that still() would end with.
  NextPicture best(const SceneKind& kind);
  /// The last one.
  const NextPicture& again() const { return current_; }
  bool finished() const { return finished_; }

  /// What the picture asked for last took; asked for by again(), it says nothing new.
  void drawn(double ms);
  /// error=E: wants_estimate() after still(); the estimate ends the refinement if it is small enough. 1/255.
  bool wants_estimate() const {
    return quality_.goal && quality_.goal->kind == render::QualityGoal::Kind::error && kind_.rays && !by_moving_ && !rmse_;
  }
  void estimated(double rmse);
  /// With any other goal: the picture at rest is the last one, and its error is not known yet.
  bool may_estimate() const { return finished_ && kind_.rays && !by_moving_ && !rmse_; }
  const Quality& quality() const { return quality_; }
  std::optional<double> rmse() const { return rmse_; }  ///< of the picture that is shown, where it was estimated
  double budget_ms() const { return budget_ms_; }       ///< of a picture while something moves

  /// "fast, step 4, every 4th pixel, 32 ms"
  std::string words() const;

 private:
  void follow(const SceneKind& kind);
  NextPicture ask(const render::RefinementStep& step, std::uint32_t scale);

  Quality quality_;
  double budget_ms_;
  SceneKind kind_;
  render::Refinement refinement_;
  NextPicture current_;
  bool asked_ = false;      ///< the refinement waits for a time
  bool by_moving_ = false;  ///< current_ is from moving()
  bool finished_ = false;
  double shown_ms_ = 0;
  std::optional<double> rmse_;
};

}  // namespace catena::app
