#include "render/quality/lattice.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "engine/base/numbers.h"
#include "render/image/measure.h"
#include "render/quality/quality.h"
#include "render/quality/refinement.h"

namespace catena::render {
namespace {

constexpr double kDeviations = 3;                     // of the lattice's mean, that an estimate lies above it
constexpr double kFarTail = 1000, kLeastInTail = 2;   // p999: of so many samples one, of fewer the second
constexpr double kThinGoal = 6;                       // a thin part may lose that share of the error
constexpr double kFlickerGoal = 0.5;                  // the flicker, in errors, or in what the picture itself changes by
constexpr double kTurn = 0.2;                         // degrees a frame, which flicker is measured at
constexpr double kLookedAt = 4000;                    // pixels, where half a step is tried
constexpr double kSamples = 6000, kFewSamples = 800;  // covered pixels on the lattice
constexpr std::uint32_t kSpacings[] = {25, 21, 19, 17, 15, 13, 11, 9, 7, 5, 3, 1};  // pixels; odd, so that no lattice of rays is met alone
constexpr std::uint32_t kSeenSpacing = 13;                                          // where it is found what is covered
constexpr std::uint32_t kSparser = 3;   // the lattice that shows at which step rays have converged,
constexpr double kSparseSamples = 500;  // if it has so many covered pixels
// steps, voxels: of what is seen, of the fast raycast's rays that what is thin is measured by, and those of the converged picture, which
// are halved until what is left of its error is less than a share of the goal, or what rounding to 8 bits makes of nothing
constexpr double kSeenStep = 1, kFineStep = 0.25, kRoughTruthStep = 0.5, kTruthStep = 0.25, kLeastTruthStep = 0.03, kTruthShare = 0.3,
                 kRoughTruthShare = 0.5;

LatticeError compare_over_ground(const Picture& a, const Picture& b) {
  PixelErrors errors = covered_errors(a, b);
  const auto count = double(errors.squares.size());
  if (count == 0) return {};
  double sum = 0, squares = 0;
  for (const double here : errors.squares) {
    sum += here;
    squares += here * here;
  }
  const double mean = sum / count, variance = std::max(0.0, squares / count - mean * mean);
  // of few samples the largest alone says little of the 99.9 percentile
  const double tail = std::max(1 / kFarTail, kLeastInTail / count);
  return {std::sqrt(mean), std::sqrt(mean + kDeviations * std::sqrt(variance / count)), quantile(errors.largest, 1 - std::min(1.0, tail))};
}

/// A picture that lies over the first ground, over the one of that number: the second is white, and then the first was black.
Picture over_ground(Picture picture, std::size_t ground) {
  if (ground == 0) return picture;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
    for (std::size_t c = i; c < i + 3; ++c) picture.rgba[c] = std::uint8_t(std::min(255, picture.rgba[c] + 255 - picture.rgba[i + 3]));
  return picture;
}

/// The same seen by a camera that has gone a little around its target.
FramePacket turned(const FramePacket& packet) {
  FramePacket out = packet;
  const Vec3 turn = direction(packet.view.up) * (kTurn * std::numbers::pi / 180);
  out.view.position = packet.view.target + rotate(rotation_of(turn), packet.view.position - packet.view.target);
  return out;
}

/// The lattice's pixels of a finished picture.
Picture on_lattice(const Picture& picture, std::uint32_t spacing) {
  Picture out;
  out.width = (picture.width + spacing - 1) / spacing;
  out.height = (picture.height + spacing - 1) / spacing;
  for (std::uint32_t y = 0; y < picture.height; y += spacing)
    for (std::uint32_t x = 0; x < picture.width; x += spacing)
      out.rgba.insert(out.rgba.end(), picture.pixel(x, y), picture.pixel(x, y) + 4);
  return out;
}

}  // namespace

Lattice::Lattice(Renderer& renderer, const FramePacket& packet, LatticeSize size) : renderer_(renderer), packet_(packet), size_(size) {
  if (packet_.background[3] < 1) packet_.background = {};
  grounds_.push_back({packet_.background[0], packet_.background[1], packet_.background[2]});
  if (packet_.background[3] < 1) grounds_.push_back({1, 1, 1});
  packet_.background[3] = 0;
  packet_.overlay = {};
}

Outcome Lattice::begin(double goal, bool moves) {
  // exact rays come first: what a large grid needs for them and for the fast raycast is not held at once
  CATENA_TRY(const Picture seen, renderer_.probe(packet_, converged_rung(kSeenStep), kSeenSpacing));
  double covered = 0;
  for (std::size_t i = 3; i < seen.rgba.size(); i += 4) covered += seen.rgba[i] > 0;
  covered *= double(packet_.width) * packet_.height / (double(seen.rgba.size()) / 4);
  covered_ = std::max(1.0, covered);
  const double samples = size_ == LatticeSize::whole ? kSamples : kFewSamples;
  for (const std::uint32_t spacing : kSpacings) {
    spacing_ = spacing;
    if (covered / (spacing * spacing) >= samples) break;
  }
  CATENA_CHECK(find_truth(size_ == LatticeSize::small || renderer_.draws_fast(packet_) ? goal : 0));
  if (moves && renderer_.draws_fast(packet_)) {
    CATENA_TRY(next_truth_, renderer_.probe(turned(packet_), converged_rung(truth_step_), spacing_));
    const Picture none{truth_.width, truth_.height, std::vector<std::uint8_t>(truth_.rgba.size())};
    for (const double change : flicker(none, truth_, none, next_truth_)) most_flicker_.push_back(kFlickerGoal * std::max(goal, change));
  }
  if (size_ == LatticeSize::whole) CATENA_CHECK(begin_fast());
  return Done{};
}

Result<bool> Lattice::begin_fast() {
  if (!renderer_.draws_fast(packet_)) return false;
  // it may have no memory for the grid
  CATENA_CHECK(renderer_.probe(packet_, fast_rung(kSeenStep, 1, 0, -1), kSeenSpacing));
  return fast_ = renderer_.draws_fast(packet_);
}

/// Opaque things of steep transfer functions want far shorter steps than haze does.
Outcome Lattice::find_truth(double goal) {
  const bool sparser = covered_ / std::pow(kSparser * spacing_, 2) >= kSparseSamples;
  const std::uint32_t spacing = sparser ? kSparser * spacing_ : spacing_;
  RenderSettings converged = converged_rung(goal < kRoughGoal ? kTruthStep : kRoughTruthStep);
  CATENA_TRY(truth_, renderer_.probe(packet_, converged, spacing));
  double before = 0;
  do {
    converged.step_voxels /= 2;
    CATENA_TRY(Picture finer, renderer_.probe(packet_, converged, spacing));
    const double change = compare(truth_, finer).rmse;
    // what is left where changes become r times smaller each time: by the root of two where edges leap from pixel to pixel, which opacities
    // that rise at once make, at least
    truth_error_ = change / (std::clamp(before > 0 ? before / std::max(change, 1e-30) : 2.0, std::numbers::sqrt2, 4.0) - 1);
    before = change;
    truth_ = std::move(finer);
  } while (truth_error_ > std::max(kLeastTold, (size_ == LatticeSize::small ? kRoughTruthShare : kTruthShare) * goal) &&
           converged.step_voxels > kLeastTruthStep);
  truth_step_ = converged.step_voxels;
  if (!sparser) return Done{};
  CATENA_TRY(truth_, renderer_.probe(packet_, converged, spacing_));
  return Done{};
}

Result<double> Lattice::change_of_half_step(const RenderSettings& settings) const {
  const auto spacing = std::max(1u, std::uint32_t(std::sqrt(double(packet_.width) * packet_.height / kLookedAt)));
  RenderSettings half = settings;
  half.step_voxels /= 2;
  CATENA_TRY(const Picture picture, renderer_.probe(packet_, settings, spacing));
  CATENA_TRY(const Picture finer, renderer_.probe(packet_, half, spacing));
  return compare(picture, finer).rmse;
}

bool Lattice::shaded() const { return std::ranges::any_of(packet_.volumes, &VolumeItem::shade); }

bool Lattice::empty() const {
  for (std::size_t i = 3; i < truth_.rgba.size(); i += 4)
    if (truth_.rgba[i] > 0) return false;
  return spacing_ == 1;
}

Result<LatticeError> Lattice::of_rays(const RenderSettings& settings) {
  CATENA_TRY(last_, renderer_.probe(packet_, settings, spacing_));
  return off_the_truth();
}

Result<LatticeError> Lattice::of_picture(const RenderSettings& settings) {
  CATENA_CHECK(renderer_.draw(packet_, settings));
  ++pictures_;
  CATENA_TRY(last_, drawn_lattice());
  return off_the_truth();
}

LatticeError Lattice::compare(const Picture& a, const Picture& b) const {
  LatticeError worst;
  for (std::size_t ground = 0; ground < grounds_.size(); ++ground) {
    const LatticeError error = compare_over_ground(over_ground(a, ground), over_ground(b, ground));
    worst = {std::max(worst.rmse, error.rmse), std::max(worst.above, error.above), std::max(worst.p999, error.p999)};
  }
  return worst;
}

std::vector<double> Lattice::flicker(const Picture& last, const Picture& last_truth, const Picture& now, const Picture& truth) const {
  std::vector<double> each;
  for (std::size_t ground = 0; ground < grounds_.size(); ++ground)
    each.push_back(
        flicker_between(over_ground(last, ground), over_ground(last_truth, ground), over_ground(now, ground), over_ground(truth, ground)));
  return each;
}

/// With what is left of the converged rays' own error, as far as it is more than rounding makes of nothing.
LatticeError Lattice::off_the_truth() const {
  LatticeError error = compare(last_, truth_);
  error.above = std::hypot(error.above, std::sqrt(std::max(0.0, truth_error_ * truth_error_ - kLeastTold * kLeastTold)));
  return error;
}

Result<std::array<double, 2>> Lattice::refined() const {
  CATENA_TRY(const auto rays, renderer_.refined_rays());
  return std::array{4 * double(rays[0]) / covered_, double(rays[1]) / covered_};
}

Result<bool> Lattice::keeps_what_is_thin(double e) {
  CATENA_TRY(const Picture picture, renderer_.read_back());
  if (fine_.rgba.empty()) {
    CATENA_CHECK(renderer_.draw(packet_, fast_rung(kFineStep, 1, 0, -1, shaded())));
    CATENA_TRY(fine_, renderer_.read_back());
    ++pictures_;
  }
  for (const std::array<float, 3>& ground : grounds_) {
    const PictureError error = measure_error(picture, fine_, ground);
    if (error.least_kept < 1 - e / kThinGoal || error.p999 > kFarthest * e) return false;
  }
  return true;
}

bool Lattice::lattice_keeps_what_is_thin(double e) const {
  for (std::size_t ground = 0; ground < grounds_.size(); ++ground)
    if (measure_error(over_ground(last_, ground), over_ground(truth_, ground)).least_kept < 1 - e / kThinGoal) return false;
  return true;
}

/// Of the picture that was drawn last.
Result<Picture> Lattice::drawn_lattice() {
  CATENA_TRY(const Picture picture, renderer_.read_back());
  return over(on_lattice(picture, spacing_), grounds_.front());
}

bool Lattice::is_steady(const Picture& after) const {
  return std::ranges::equal(flicker(last_, truth_, after, next_truth_), most_flicker_, std::less_equal<>());
}

Result<bool> Lattice::rays_are_steady(const RenderSettings& settings) {
  CATENA_TRY(const Picture after, renderer_.probe(turned(packet_), settings, spacing_));
  return is_steady(after);
}

Result<bool> Lattice::picture_is_steady(const RenderSettings& settings) {
  CATENA_CHECK(renderer_.draw(turned(packet_), settings));
  ++pictures_;
  CATENA_TRY(const Picture after, drawn_lattice());
  return is_steady(after);
}

}  // namespace catena::render
