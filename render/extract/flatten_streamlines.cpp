// SPDX-License-Identifier: MIT
#include "render/extract/flatten_streamlines.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/memory_limit.h"
#include "engine/base/numbers.h"
#include "engine/base/threads.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/labels.h"
#include "engine/scene/streamlines.h"
#include "render/extract/colored_tubes.h"
#include "render/extract/extract_internal.h"
#include "render/extract/stretch.h"

namespace catena::render {

namespace {

constexpr double kTubeShare = 0.003;  ///< fitted tube radius / domain diagonal
constexpr double kMaxArrows = 100000;
constexpr double kPulseShare = 1.0 / 12;  ///< maximum segment length / pulse length
constexpr double kErrors[] = {0.02, 0.05, 0.1, 0.2};
constexpr double kFinest = 1e-6;             ///< minimum error / domain length
constexpr std::size_t kTrialLines = 64;      ///< number of lines that the error is chosen by
constexpr std::size_t kBytesPerPoint = 100;  ///< memory of a drawn point: position, value, color, ring
constexpr std::size_t kLinesAtOnce = 8;

/// Evaluates the quantity of "color_by" along a streamline.
class LineValue {
 public:
  LineValue(const scene::ColorBy& by, field::AnyField shown, field::VectorFieldPtr flow)
      : by_(by), shown_(std::move(shown)), flow_(std::move(flow)) {}
  double at(const FlattenedPoint& point) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    if (by_.source == scene::ColorBy::Source::arc_length) return point.arc_length;
    const field::VectorField* vector = by_.source == scene::ColorBy::Source::speed ? flow_.get() : shown_.vector.get();
    if (vector != nullptr) {
      const field::VectorSample sample = vector->sample(point.position, cursor_);
      return sample.inside ? norm(sample.value) : none;
    }
    const field::ScalarSample sample = shown_.scalar->sample(point.position, cursor_);
    return sample.inside ? sample.value : none;
  }
  /// Returns the maximum segment length that resolves the quantity, in world units; 0: no limit.
  double detail() const {
    if (by_.source == scene::ColorBy::Source::arc_length) return 0;
    const field::Field* field = by_.source == scene::ColorBy::Source::speed ? flow_.get() : shown_.get();
    return field->is_grid() ? field->max_voxel_edge() : field->domain_length() / 128;
  }

 private:
  const scene::ColorBy& by_;
  field::AnyField shown_;
  field::VectorFieldPtr flow_;
  field::Cursor cursor_;
};

void add_arrows(const flow::Curve& curve, double spacing, double radius, std::vector<ArrowItem>& arrows,
                std::vector<FlattenedPoint>& places) {
  const double first = curve.knots().front().s, last = curve.knots().back().s, length = std::min(kArrowLength * radius, 0.8 * spacing);
  for (double n = std::ceil((first + 0.5 * length) / spacing - 0.5); (n + 0.5) * spacing <= last - 0.5 * length; ++n) {
    const double s = (n + 0.5) * spacing;
    Vec3 p, t;
    curve.evaluate_interval(curve.find_interval(s), s, p, t);
    t = direction(t);
    arrows.push_back({p - (0.5 * length) * t, p + (0.5 * length) * t, kArrowRadius * radius, {}});
    places.push_back({p, s});
  }
}

/// Returns the diagonal of the domain; for a formula that of its drawn box.
double shown_diagonal(const scene::Scene& scene, const scene::StreamlineSet& set, const field::Field& flow) {
  if (flow.is_grid()) return domain_diagonal(flow);
  const std::array<double, 2>& box = scene.entities.get<scene::FieldSource>(set.field).box;
  return std::sqrt(3.0) * (box[1] - box[0]);
}

/// Flattens the lines of a set, each once, as the integrator delivers them.
class Flattener {
 public:
  Flattener(scene::Scene& scene, const scene::StreamlineSet& set, field::VectorFieldPtr flow, field::AnyField shown)
      : scene_(scene), set_(set), flow_(std::move(flow)), shown_(std::move(shown)) {
    flat_.radius = set.radius > 0 ? set.radius : kTubeShare * shown_diagonal(scene, set, *flow_);
    error_share_ = size_scale(flow_->world_bounds(), scene.stretch) / std::max({scene.stretch.x, scene.stretch.y, scene.stretch.z});
    if (set.color_by) value_.emplace(*set.color_by, shown_, flow_);
  }
  Outcome add(const scene::LineBlock& block);
  Result<FlattenedStreamlines> finish();

 private:
  /// A flattened curve.
  struct Line {
    std::vector<Vec3> points;
    std::vector<double> arc_lengths, values;
  };
  Line line_of(const flow::Curve& curve, std::optional<LineValue>& value) const;
  FlattenOptions options_for(const flow::Curve& curve) const;
  Outcome choose_error(const scene::LineBlock& block);
  Outcome check_arrows(const scene::LineBlock& block);
  void take(Line line);

  scene::Scene& scene_;
  const scene::StreamlineSet& set_;
  field::VectorFieldPtr flow_;
  field::AnyField shown_;
  std::optional<LineValue> value_;
  double error_ = 0;            ///< in tube radii; 0: not chosen yet
  double error_share_ = 1;      ///< reduces the error where a stretch enlarges it, against the radius
  double length_ = 0;           ///< total length of the curves so far
  std::vector<double> values_;  ///< one per point of all tubes
  std::vector<FlattenedPoint> arrow_places_;
  FlattenedStreamlines flat_;
};

FlattenOptions Flattener::options_for(const flow::Curve& curve) const {
  FlattenOptions options{flat_.radius, error_share_ * std::max(error_, kFinest * curve.domain_length() / flat_.radius)};
  double detail = value_ ? value_->detail() : 0;
  if (value_ && detail == 0) detail = curve.period() / 64;
  const double band = kPulseShare * set_.band_length;
  options.max_segment = detail > 0 && band > 0 ? std::min(detail, band) : std::max(detail, band);
  return options;
}

Flattener::Line Flattener::line_of(const flow::Curve& curve, std::optional<LineValue>& value) const {
  Line line;
  for (const FlattenedPoint& flattened : flatten_with_arc_length(curve, options_for(curve))) {
    line.points.push_back(flattened.position);
    if (set_.band_length > 0) line.arc_lengths.push_back(flattened.arc_length);
    if (value) line.values.push_back(value->at(flattened));
  }
  line.points.shrink_to_fit();
  return line;
}

/// Chooses the smallest error that keeps the set within its share of points, estimated from the first lines.
Outcome Flattener::choose_error(const scene::LineBlock& block) {
  const std::size_t tried = std::min(kTrialLines, block.curves.size());
  const double lines =
      static_cast<double>(block.curves.size()) * static_cast<double>(block.seeds_total) / static_cast<double>(block.seeds_done);
  double points = 0;
  for (const double error : kErrors) {
    error_ = error;
    points = 0;
    for (std::size_t i = 0; i < tried; ++i) {
      const flow::Curve& curve = *block.curves[i * block.curves.size() / tried];
      points += static_cast<double>(flatten_with_arc_length(curve, options_for(curve)).size());
    }
    points *= lines / static_cast<double>(tried);
    if (points <= kPointsPerLine * std::max(lines, kMinLineCount)) break;
  }
  return check_memory_available("drawing " + to_text(std::round(lines)) + " streamlines", points * kBytesPerPoint);
}

/// Error: the arrow spacing would give more than kMaxArrows arrows, which would fill the memory.
Outcome Flattener::check_arrows(const scene::LineBlock& block) {
  for (const flow::CurvePtr& curve : block.curves) length_ += curve->period();
  if (!(set_.arrow_spacing > 0) || !(length_ / set_.arrow_spacing > kMaxArrows)) return Done{};
  return json::error_at(json::member_or_parent(set_.where, "arrows"),
                        "\"arrows\" this close would be more than 100000 on the lines, of which " + std::to_string(block.seeds_done) +
                            " are " + to_text(length_) + " long together; a longer spacing was expected");
}

void Flattener::take(Line line) {
  TubeItem tube{{}, flat_.radius, set_.color, {}};
  tube.points = std::move(line.points);
  flat_.tubes.push_back(std::move(tube));
  if (set_.band_length > 0) flat_.arc_lengths.push_back(std::move(line.arc_lengths));
  values_.insert(values_.end(), line.values.begin(), line.values.end());
}

Outcome Flattener::add(const scene::LineBlock& block) {
  if (block.curves.empty()) return Done{};
  if (error_ == 0) CATENA_CHECK(choose_error(block));
  CATENA_CHECK(check_arrows(block));
  std::vector<Line> lines(block.curves.size());
  parallel_for(lines.size(), kLinesAtOnce, [&](std::size_t begin, std::size_t end) {
    std::optional<LineValue> value = value_;
    for (std::size_t i = begin; i < end; ++i) lines[i] = line_of(*block.curves[i], value);
  });
  for (Line& line : lines) take(std::move(line));
  if (set_.arrow_spacing > 0)
    for (const flow::CurvePtr& curve : block.curves) add_arrows(*curve, set_.arrow_spacing, flat_.radius, flat_.arrows, arrow_places_);
  return Done{};
}

Result<FlattenedStreamlines> Flattener::finish() {
  if (!value_) {
    for (ArrowItem& arrow : flat_.arrows) arrow.color = set_.color;
    return std::move(flat_);
  }
  const scene::ColorBy& by = *set_.color_by;
  const field::AnyField of = by.source == scene::ColorBy::Source::speed ? field::AnyField{{}, flow_} : shown_;
  const DisplayRange range = field::display_range(values_, of);
  CATENA_CHECK(scene::check_mapping(by, range.lo));
  flat_.colors = shown_.get() == nullptr ? scene::make_color_table(by.colors, by.named, range.lo, range.hi)
                                         : scene::make_display_color_table(scene_, by.field, by.colors, by.named, range.lo, range.hi);
  std::size_t first = 0;
  std::vector<TubeItem> tubes;
  std::vector<std::vector<double>> arc_lengths;
  for (std::size_t line = 0; line < flat_.tubes.size(); ++line) {
    const TubeItem& tube = flat_.tubes[line];
    const std::span<double> values = std::span(values_).subspan(first, tube.points.size());
    first += values.size();
    // a line ends on the face of the domain; rounding may put its end outside, where the field has no value
    if (values.size() > 1 && std::isnan(values.front())) values.front() = values[1];
    if (values.size() > 1 && std::isnan(values.back())) values.back() = values[values.size() - 2];
    const std::vector<LinePart> parts = add_colored_tubes(tube, values, flat_.colors, by.named.threshold, tubes);
    if (!flat_.arc_lengths.empty())
      for (const LinePart& part : parts) arc_lengths.push_back(entries_of<double>(part, flat_.arc_lengths[line]));
  }
  flat_.tubes = std::move(tubes);
  flat_.arc_lengths = std::move(arc_lengths);
  std::vector<ArrowItem> arrows;
  for (std::size_t i = 0; i < flat_.arrows.size(); ++i) {
    const double value = value_->at(arrow_places_[i]);
    if (!is_within(by.named.threshold, value)) continue;
    arrows.push_back(flat_.arrows[i]);
    arrows.back().color = sample_color_table(flat_.colors, value);
  }
  flat_.arrows = std::move(arrows);
  return std::move(flat_);
}

}  // namespace

double domain_diagonal(const field::Field& field) {
  return norm(field.mapping().world_from_index_linear * (field.index_box().hi - field.index_box().lo));
}

Result<FlattenedStreamlines> flatten_streamlines(scene::Scene& scene, scene::Entity entity) {
  const scene::StreamlineSet& set = scene.entities.get<scene::StreamlineSet>(entity);
  CATENA_TRY(const field::AnyField flow, scene::resolve_field(scene, set.field, set.where));
  field::AnyField shown;
  if (set.color_by && set.color_by->source == scene::ColorBy::Source::field) {
    CATENA_TRY(shown, scene::resolve_field(scene, set.color_by->field, set.where));
  }
  if (!flow.vector) CATENA_CHECK(scene::resolve_lines(scene, entity));  // reports why there is no flow
  Flattener flattener(scene, set, flow.vector, shown);
  CATENA_CHECK(scene::visit_lines(scene, entity, [&](const scene::LineBlock& block) { return flattener.add(block); }));
  CATENA_TRY(FlattenedStreamlines made, flattener.finish());
  made.version = scene::lines_version(scene, entity);
  return made;
}

}  // namespace catena::render
