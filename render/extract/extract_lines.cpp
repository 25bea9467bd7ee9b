#include "render/extract/extract_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/base/numbers.h"
#include "engine/base/result.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/hidden.h"
#include "engine/scene/labels.h"
#include "engine/scene/lines.h"
#include "render/extract/flatten.h"

namespace catena::render {

namespace {

constexpr double kTubeShare = 0.003;       // fitted tube radius by the domain's diagonal
constexpr double kIndicatorShare = 0.004;  // the same of the indicator
constexpr double kIndicatorLength = 0.1;   // of L
constexpr double kMaxArrows = 100000;
constexpr std::size_t kMaxKeptKnots = 2000000;  // of a set: above it the curves go once they are polylines
constexpr double kPulseShare = 1.0 / 12;        // of a pulse: the longest segment
constexpr double kDimmest = 0.25;               // brightness between pulses

/// What this room keeps beside a StreamlineSet: each curve as a polyline with values, made once.
struct FlatLines {
  std::uint64_t version = 0;  ///< of the lines (scene::lines_version)
  double radius = 0;
  std::vector<TubeItem> tubes;
  std::vector<std::vector<double>> arc_lengths;  ///< by point
  std::vector<ArrowItem> arrows;
  ColorTable colors;  ///< of "color_by"
};

double domain_diagonal(const field::Field& field) {
  return norm(field.mapping().world_from_index_linear * (field.index_box().hi - field.index_box().lo));
}

/// What a set's colours show, at a place of a line.
class LineValue {
 public:
  LineValue(const scene::ColorBy& by, field::AnyField shown, field::VectorFieldPtr flow)
      : by_(by), shown_(std::move(shown)), flow_(std::move(flow)) {}
  double at(const FlatPoint& point) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    if (by_.what == scene::ColorBy::What::arc_length) return point.s;
    const field::VectorField* vector = by_.what == scene::ColorBy::What::speed ? flow_.get() : shown_.vector.get();
    if (vector != nullptr) {
      const field::VectorSample sample = vector->sample(point.p, cursor_);
      return sample.inside ? norm(sample.value) : none;
    }
    const field::ScalarSample sample = shown_.scalar->sample(point.p, cursor_);
    return sample.inside ? sample.value : none;
  }
  /// The finest detail of what is shown: a segment's longest length.
  double detail() const {
    if (by_.what == scene::ColorBy::What::arc_length) return 0;
    const field::Field* field = by_.what == scene::ColorBy::What::speed ? flow_.get() : shown_.get();
    return field->is_grid() ? field->longest_edge() : field->length() / 128;
  }

 private:
  const scene::ColorBy& by_;
  field::AnyField shown_;
  field::VectorFieldPtr flow_;
  field::Cursor cursor_;
};

void add_arrows(const flow::Curve& curve, double spacing, double radius, std::vector<ArrowItem>& arrows, std::vector<FlatPoint>& places) {
  const double first = curve.knots().front().s, last = curve.knots().back().s, length = std::min(kArrowLength * radius, 0.8 * spacing);
  for (double n = std::ceil((first + 0.5 * length) / spacing - 0.5); (n + 0.5) * spacing <= last - 0.5 * length; ++n) {
    const double s = (n + 0.5) * spacing;
    Vec3 p, t;
    curve.evaluate_in(curve.interval_of(s), s, p, t);
    t = direction(t);
    arrows.push_back({p - (0.5 * length) * t, p + (0.5 * length) * t, kArrowRadius * radius, {}});
    places.push_back({p, s});
  }
}

/// Of the domain; of a formula that of the box of its picture.
double shown_diagonal(const scene::Scene& scene, const scene::StreamlineSet& set, const field::Field& flow) {
  if (flow.is_grid()) return domain_diagonal(flow);
  const std::array<double, 2>& box = scene.world.get<scene::FieldSource>(set.field).box;
  return std::sqrt(3.0) * (box[1] - box[0]);
}

Result<FlatLines> flat_lines(scene::Scene& scene, const scene::StreamlineSet& set, std::vector<flow::CurvePtr> curves,
                             const field::VectorFieldPtr& flow) {
  FlatLines flat;
  flat.radius = set.radius > 0 ? set.radius : kTubeShare * shown_diagonal(scene, set, *flow);
  field::AnyField shown;
  if (set.color_by && set.color_by->what == scene::ColorBy::What::field) {
    CATENA_TRY(shown, scene::use_field(scene, set.color_by->field, set.where));
  }
  std::optional<LineValue> value;
  if (set.color_by) value.emplace(*set.color_by, shown, flow);
  FlattenOptions options{flat.radius};
  const double detail = value ? value->detail() : 0, band = kPulseShare * set.pulse;
  options.longest = detail > 0 && band > 0 ? std::min(detail, band) : std::max(detail, band);

  // a slip of the spacing must not fill the memory
  double all = 0;
  for (const flow::CurvePtr& curve : curves) all += curve->period();
  if (set.arrows > 0 && all / set.arrows > kMaxArrows) {
    const json::Node* node = set.where.find("arrows");
    return json::error_at(node == nullptr ? set.where : *node, "\"arrows\" this close would be more than 100000 on the lines, which are " +
                                                                   to_text(all) + " long together; a longer spacing was expected");
  }

  // places and values
  std::vector<std::vector<double>> values(curves.size());
  std::vector<FlatPoint> arrow_places;
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    TubeItem tube{{}, flat.radius, set.color, {}};
    FlattenOptions of_this = options;
    if (value && detail == 0) of_this.longest = band > 0 ? std::min(band, curves[i]->period() / 64) : curves[i]->period() / 64;
    std::vector<double> arc;
    const std::vector<FlatPoint> places = flatten_places(*curves[i], of_this);
    std::vector<Vec3> points;
    points.reserve(places.size());
    if (set.pulse > 0) arc.reserve(places.size());
    for (const FlatPoint& point : places) {
      points.push_back(point.p);
      if (set.pulse > 0) arc.push_back(point.s);
      if (!value) continue;
      values[i].push_back(value->at(point));
      if (std::isfinite(values[i].back())) {
        lo = std::min(lo, values[i].back());
        hi = std::max(hi, values[i].back());
      }
    }
    // a line ends on the domain's face, which rounding may put outside
    std::vector<double>& v = values[i];
    if (v.size() > 1 && std::isnan(v.front())) v.front() = v[1];
    if (v.size() > 1 && std::isnan(v.back())) v.back() = v[v.size() - 2];
    tube.points = std::move(points);
    flat.tubes.push_back(std::move(tube));
    if (set.pulse > 0) flat.arc_lengths.push_back(std::move(arc));
    if (set.arrows > 0) add_arrows(*curves[i], set.arrows, flat.radius, flat.arrows, arrow_places);
    curves[i].reset();
  }

  // colours
  if (value) {
    const ColorTable& table = flat.colors =
        shown.get() == nullptr ? scene::color_table(set.color_by->colors, set.color_by->named, lo, hi)
                               : scene::shown_table(scene, set.color_by->field, set.color_by->colors, set.color_by->named, lo, hi);
    for (std::size_t i = 0; i < curves.size(); ++i) {
      std::vector<Color> colors;
      colors.reserve(values[i].size());
      for (const double v : values[i]) colors.push_back(table_color(table, v));
      flat.tubes[i].colors = std::move(colors);
    }
    for (std::size_t i = 0; i < flat.arrows.size(); ++i) flat.arrows[i].color = table_color(table, value->at(arrow_places[i]));
  } else {
    for (ArrowItem& arrow : flat.arrows) arrow.color = set.color;
  }
  return flat;
}

/// The tube with its colours dimmed between the pulses.
TubeItem with_pulse(TubeItem tube, const std::vector<double>& arc, double pulse, double phase) {
  std::vector<Color> colors = tube.colors.empty() ? std::vector<Color>(tube.points.size(), tube.color) : tube.colors.list();
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const double wave = 0.5 + 0.5 * std::cos(2 * std::numbers::pi * (arc[i] / pulse - phase));
    const auto bright = static_cast<float>(kDimmest + (1 - kDimmest) * wave * wave);
    Color& c = colors[i];
    c = {bright * c.r, bright * c.g, bright * c.b};
  }
  tube.colors = std::move(colors);
  return tube;
}

}  // namespace

Color table_color(const ColorTable& table, double value) {
  CATENA_ASSERT(!table.empty());
  if (std::isnan(value)) return {0.5f, 0.5f, 0.5f};
  if (value <= table.front().value) return table.front().color;
  if (value >= table.back().value) return table.back().color;
  const auto next = std::upper_bound(table.begin(), table.end(), value, [](double v, const auto& point) { return v < point.value; });
  const auto &a = *(next - 1), &b = *next;
  const auto t = static_cast<float>((value - a.value) / (b.value - a.value));
  return {a.color.r + t * (b.color.r - a.color.r), a.color.g + t * (b.color.g - a.color.g), a.color.b + t * (b.color.b - a.color.b)};
}

const ColorTable* shown_colors(const scene::World& made, scene::Entity set) { return kept_colors<FlatLines>(made, set); }

Outcome prepare_streamlines(scene::Scene& scene) {
  for (const scene::Entity e : owners_of<scene::StreamlineSet>(scene.world)) {
    if (is_hidden(scene.world, e)) continue;
    if (!scene.made.has<FlatLines>(e)) scene.made.emplace<FlatLines>(e);
    const std::uint64_t version = scene::lines_version(scene, e);
    if (version != 0 && scene.made.get<FlatLines>(e).version == version) continue;
    CATENA_TRY(std::vector<flow::CurvePtr> curves, scene::use_lines(scene, e));
    std::size_t knots = 0;
    for (const flow::CurvePtr& curve : curves) knots += curve->knots().size();
    if (knots > kMaxKeptKnots) scene::release_lines(scene, e);
    const scene::StreamlineSet& set = scene.world.get<scene::StreamlineSet>(e);
    CATENA_TRY(const field::AnyField any, scene::use_field(scene, set.field, set.where));
    CATENA_TRY(FlatLines made, flat_lines(scene, set, std::move(curves), any.vector));
    made.version = scene::lines_version(scene, e);
    scene.made.get<FlatLines>(e) = std::move(made);
  }
  return Done{};
}

void extract_streamlines(const scene::Scene& scene, FramePacket& packet) {
  scene.world.each<scene::StreamlineSet>([&](scene::Entity e, const scene::StreamlineSet& set) {
    if (is_hidden(scene.world, e)) return;
    const FlatLines& flat = scene.made.get<FlatLines>(e);
    const std::uint32_t id = packet.add_object("streamlines", name_of(scene, set.field), set.where.label);
    const auto add = [&](auto& items, auto item) {
      item.id = id;
      item.clipped = set.clipped;
      items.push_back(std::move(item));
    };
    for (std::size_t i = 0; i < flat.tubes.size(); ++i)
      add(packet.tubes, set.pulse > 0 ? with_pulse(flat.tubes[i], flat.arc_lengths[i], set.pulse, scene.phase) : flat.tubes[i]);
    for (const ArrowItem& arrow : flat.arrows) add(packet.arrows, arrow);
  });
}

Outcome extract_indicators(const scene::Scene& scene, FramePacket& packet) {
  for (const scene::Entity e : owners_of<scene::Indicator>(scene.world)) {
    const scene::Indicator& indicator = scene.world.get<scene::Indicator>(e);
    const field::AnyField& any = scene::loaded_field(scene, indicator.field);
    if (!any.vector) return json::error_at(indicator.where, "\"indicator\" names a scalar field; a vector field was expected");
    const double length = indicator.length > 0 ? indicator.length : kIndicatorLength * any.vector->length();
    const double radius = indicator.radius > 0 ? indicator.radius : kIndicatorShare * domain_diagonal(*any.vector);
    for (const CursorItem& cursor : packet.cursors) {
      flow::TraceOptions options;
      options.length = indicator.ahead ? length : 0.5 * length;
      options.tolerance = 1e-7;
      options.hermite_tolerance = 1e-6;
      const auto curve = flow::trace({any.vector.get()}, cursor.probe, options);
      if (!curve) continue;
      const flow::Knot& end = (*curve)->closed() ? (*curve)->knots().front() : (*curve)->knots().back();
      const bool cut = indicator.ahead && !(*curve)->closed();
      std::vector<Vec3> points;
      if (cut) points.push_back(cursor.probe);
      for (const FlatPoint& place : flatten_places(**curve, {radius}))
        if (!cut || place.s > 0) points.push_back(place.p);
      if (points.size() < 2) continue;
      IndicatorItem item{{std::move(points), radius, indicator.color, {}},
                         {end.p, end.p + (kArrowLength * radius) * end.t, kArrowRadius * radius, indicator.color}};
      item.tube.id = packet.add_object("indicator", "");
      packet.indicators.push_back(std::move(item));
    }
  }
  return Done{};
}

}  // namespace catena::render
