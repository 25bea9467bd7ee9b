/// The frame packet: everything one picture needs, as plain data. Copied by render/extract; the ECS is not read after it.
/// Fields are held by shared pointer (kept alive while the frame uses them) and never looked into here.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/bounds.h"
#include "engine/base/color.h"
#include "engine/base/plane.h"
#include "engine/base/vec.h"
#include "render/frame/overlay_items.h"
#include "render/frame/packing.h"

namespace catena::field {
class ScalarGrid;
}

namespace catena::render {

/// A part of the symmetric frustum of a view, or beyond it, in its half extents: an eye off the axis, a tile of a large picture.
struct FrustumWindow {
  double left = -1, right = 1, bottom = -1, top = 1;  ///< -1 and 1 are the edges of the symmetric frustum
  bool operator==(const FrustumWindow&) const = default;
};

/// Where the eye is and what it sees. World units.
struct View {
  Vec3 position{0.0}, target{0.0}, up{0.0, 0.0, 1.0};  ///< the eye, what it looks at, what is up
  double fovy_deg = 30;                                ///< vertical angle of view, degrees
  bool orthographic = false;                           ///< no perspective
  double height = 1;                                   ///< orthographic: world units from bottom to top
  FrustumWindow window{};                              ///< the part of it that is drawn
  double aspect = 0;                                   ///< width by height of the symmetric frustum; 0: as pixels are square
  bool operator==(const View&) const = default;
};

/// A light from far away; `direction` points to it. In the world, or in the view: right, up, towards the eye.
struct LightItem {
  Vec3 direction{0.0, 0.0, 1.0};  ///< towards the light
  Color color{1, 1, 1};           ///< times the intensity
  bool camera_relative = false;   ///< the axes are the view's
  bool operator==(const LightItem&) const = default;
};

/// Depth cue: at view depth `end` and beyond, `most` of a colour is the fog's; nothing of it at `start`.
struct FogItem {
  Color color;                                  ///< the fog's
  double near = 0, far = 1, max_opacity = 0.8;  ///< view depths in world units; share at `end`
  bool operator==(const FogItem&) const = default;
};

/// What an id of the picture stands for.
struct ObjectName {
  std::uint32_t id = 0;      ///< as in the id picture, from 1 on
  std::string kind, name;    ///< "isosurface" and the like; the name in the scene
  std::string scene_path{};  ///< where it stands in the scene, "isosurfaces[1]"; empty: it is no item of a list
};

/// Linear between points (value, columns..) that rise, constant beyond them; 0 without any. Of two at one value the later counts from
/// there.
template <class Points>
double interpolate_piecewise(const Points& points, double value, std::size_t column) {
  if (points.empty()) return 0;
  const auto above = std::upper_bound(points.begin(), points.end(), value, [](double v, const auto& p) { return v < p[0]; });
  if (above == points.begin()) return points.front()[column];
  if (above == points.end()) return points.back()[column];
  const auto& a = *(above - 1);
  const auto& b = *above;
  const double f = (value - a[0]) / (b[0] - a[0]);
  return a[column] + f * (b[column] - a[column]);
}

/// Piecewise-linear over field values; sigma is extinction per world unit.
struct TransferTable {
  std::vector<std::array<double, 4>> colors;       ///< value, r, g, b
  std::vector<std::array<double, 2>> extinctions;  ///< value, sigma
  /// gradient (field units per world unit), factor 0..1 that multiplies sigma; empty: 1
  std::vector<std::array<double, 2>> gradient_factors;
  double opacity_length = 0;    ///< the length whose opacity a projection takes, world units; 0: the smallest voxel edge
  bool is_categorical = false;  ///< values are whole numbers, each with a look of its own
  /// The scale (engine/base/symlog_scale.h) on which tables made of it are even: where the points lie close on it, they suffice.
  double linear_below = 0;
  bool operator==(const TransferTable&) const = default;
};

/// How a ray makes one colour of its values.
///   composite   emission and absorption
///   maximum     colour and opacity, over the table's opacity_length, of the greatest value that the ray meets; minimum alike
///   average     the same of the mean of its values
enum class Projection { composite, maximum, minimum, average };

/// Colours by another field at the same world place. Where that field has no value the item's own colour holds.
struct ColorSource {
  std::shared_ptr<const field::ScalarGrid> grid;  ///< whose values give the colours
  std::vector<std::array<double, 4>> colors;      ///< value, r, g, b
  bool is_categorical = false;                    ///< values are whole numbers, each with a colour of its own; 0 is no label and has none
  bool spread_labels = false;  ///< where the nearest voxel is no label: the colour of the nearest one that is, of the cell
  double linear_below = 0;     ///< as of a TransferTable
  bool operator==(const ColorSource&) const = default;
};

/// A volume that rays go through.
struct VolumeItem {
  std::shared_ptr<const field::ScalarGrid> grid;  ///< the values
  TransferTable transfer;                         ///< colours and extinctions
  bool is_shaded = false;                         ///< lit by the gradient
  std::uint32_t id = 0;                           ///< in the id picture; 0: none
  bool is_clipped = true;                         ///< the clip planes cut it
  Projection projection = Projection::composite;  ///< what a ray makes of its values
  std::optional<ColorSource> color_by{};          ///< composite only
  bool operator==(const VolumeItem&) const = default;
};

/// An isosurface that rays meet.
struct IsosurfaceItem {
  std::shared_ptr<const field::ScalarGrid> grid;  ///< the values
  double level = 0;                               ///< the value on the surface
  Color color;                                    ///< where nothing else gives one
  float opacity = 1;                              ///< 0 to 1, of one side
  std::uint32_t id = 0;                           ///< in the id picture; 0: none
  bool is_clipped = true;                         ///< the clip planes cut it
  std::optional<ColorSource> color_by{};          ///< none: `color` everywhere
  bool operator==(const IsosurfaceItem&) const = default;
};

/// Triangles as they are: what the hand feels. Made once a mesh, shared by frames.
struct MeshGeometry {
  std::vector<Vec3> vertices;            ///< places, world units
  std::vector<std::uint32_t> triangles;  ///< three indices each, counter-clockwise from outside
  std::vector<Vec3> normals{};           ///< by vertex, for smooth shading; may be empty without it
  std::vector<Color> colors{};           ///< by vertex; empty: the item's everywhere
  bool operator==(const MeshGeometry&) const = default;
};

/// Triangles that are drawn.
struct MeshItem {
  std::shared_ptr<const MeshGeometry> geometry;  ///< shared by frames
  Color color;                                   ///< where nothing else gives one
  std::uint32_t id = 0;                          ///< in the id picture; 0: none
  bool is_clipped = true;                        ///< the clip planes cut it
  float opacity = 1;                             ///< of one side; < 1: drawn in the layers
  bool smooth = false;                           ///< lit by the vertices' normals, not by each triangle's own
  bool show_edges = false;                       ///< the triangles' edges as lines
  /// Equal triangles are equal, wherever they are kept.
  bool operator==(const MeshItem& other) const {
    const bool alike = geometry == other.geometry || (geometry && other.geometry && *geometry == *other.geometry);
    return alike && color == other.color && id == other.id && is_clipped == other.is_clipped && opacity == other.opacity &&
           smooth == other.smooth && show_edges == other.show_edges;
  }
};

/// A plane through a grid, coloured by its values. Lines of constant value lie over it, opaque whatever the slice is.
struct SliceItem {
  std::shared_ptr<const field::ScalarGrid> grid;  ///< the values
  Vec3 point{0.0}, normal{0.0, 0.0, 1.0};         ///< world; normal need not be unit
  std::vector<std::array<double, 4>> colors;      ///< value, r, g, b; piecewise linear
  float opacity = 1;                              ///< < 1: drawn in the layers
  bool lit = false;                               ///< lit, or the plain colours of the values
  std::vector<double> contour_levels{};           ///< of the lines, rising
  Color line_color{0, 0, 0};                      ///< of the lines
  float line_width = 1;                           ///< pixels
  std::uint32_t id = 0;                           ///< in the id picture; 0: none
  bool is_clipped = true;                         ///< the clip planes cut it
  int stack_order = 0;                            ///< so many slices before it lie in the same plane: it lies over them
  std::optional<double> hidden_label{};           ///< nothing is drawn within a half of this value
  bool operator==(const SliceItem&) const = default;
};

/// A tube around a polyline, already flattened from the curve finely enough for its radius.
struct TubeItem {
  SharedList<Vec3> points;     ///< corners of the polyline, world units; one: a ball
  double radius = 0;           ///< world units
  Color color;                 ///< where nothing else gives one
  SharedList<Color> colors{};  ///< by point; empty: `color` everywhere
  std::uint32_t id = 0;        ///< in the id picture; 0: none
  bool is_clipped = true;      ///< the clip planes cut it
  bool operator==(const TubeItem&) const = default;
};

/// An arrowhead: a cone.
struct ArrowItem {
  Vec3 base{0.0}, tip{0.0};  ///< middle of the cone's base; its tip; world units
  double radius = 0;         ///< of the base, world units
  Color color;               ///< where nothing else gives one
  std::uint32_t id = 0;      ///< in the id picture; 0: none
  bool is_clipped = true;    ///< the clip planes cut it
  bool operator==(const ArrowItem&) const = default;
};

/// An arrow of a vector.
struct Glyph {
  Vec3 tail{0.0}, tip{0.0};  ///< its two ends, world units
  Color color;               ///< where nothing else gives one
  bool operator==(const Glyph&) const = default;
};

/// Arrows of one shape: a cylinder and a cone, whose sizes follow each one's length.
struct GlyphItem {
  SharedList<Glyph> glyphs;    ///< of this shape
  double shaft_radius = 0.06;  ///< its radius
  double head_length = 0.36;   ///< the cone's length; 0: none, the cylinder goes to the tip
  double head_radius = 0.144;  ///< of the cone's base
  std::uint32_t id = 0;        ///< in the id picture; 0: none
  bool is_clipped = true;      ///< the clip planes cut it
  bool operator==(const GlyphItem&) const = default;
};

/// The local indicator: a short piece of the streamline through the cursor, with an arrowhead downstream.
struct IndicatorItem {
  TubeItem tube;    ///< the piece
  ArrowItem arrow;  ///< its arrowhead
  bool operator==(const IndicatorItem&) const = default;
};

/// The cursor: probe, the proxy of every link, the links between them, the force. Clip planes do not touch it.
struct CursorItem {
  Vec3 probe{0.0};                     ///< the hand, world units
  std::vector<Vec3> proxies;           ///< by link, world units
  std::vector<bool> link_active;       ///< by link: it holds
  Vec3 force_n{0.0};                   ///< world axes, newtons
  double radius = 0;                   ///< radius of the probe's ball, world units
  std::vector<double> release_ratios;  ///< by link: 0 on its feature .. 1 where the hand has left it; empty: all 0
  std::uint32_t id = 0;                ///< in the id picture; 0: none
  /// Where nothing can push back (a mouse), the picture does: the cursor is the last proxy, the probe a small ball on a tether whose
  /// colour and width say the force, 0..1 of the largest. None: as it is.
  std::optional<double> force_ratio{};
  bool show_occluded = true;         ///< it shines through what hides it
  bool is_crosshair = false;         ///< three rods along the axes, twice `size` long; no proxies, no force
  std::optional<Vec3> foot_point{};  ///< a thin line leads from the probe to here, to a cross at right angles to it
  bool operator==(const CursorItem&) const = default;
};

/// Bounding boxes, axes, the ground: help for the eye, not data. The camera is not fitted to them; clip planes do not touch them.
struct EnvironmentItems {
  std::vector<TubeItem> tubes;   ///< edges
  std::vector<MeshItem> meshes;  ///< faces
  /// Whether there is nothing.
  bool empty() const { return tubes.empty() && meshes.empty(); }
  bool operator==(const EnvironmentItems&) const = default;
};

/// What the hand takes hold of (paper, Figure 6). A tube of a single point is a ball. The camera is not fitted to them.
struct WidgetItems {
  std::vector<TubeItem> tubes;    ///< edges and handles
  std::vector<ArrowItem> arrows;  ///< arrowheads
  std::vector<MeshItem> meshes;   ///< faces
  /// Whether there is nothing.
  bool empty() const { return tubes.empty() && arrows.empty() && meshes.empty(); }
  bool operator==(const WidgetItems&) const = default;
};

/// SphereSet at points, made once a set, shared by frames.
struct SphereSet {
  Vec3 origin{0.0};                                                         ///< of the places
  std::vector<glm::vec3> offsets;                                           ///< less `origin`
  std::vector<float> radii;                                                 ///< one a place
  std::vector<Color> colors;                                                ///< one a place
  Bounds robust_bounds{};                                                   ///< what a first view shows of them; empty: all
  Vec3 position(std::size_t i) const { return origin + Vec3(offsets[i]); }  ///< in the world
};

/// SphereSet at points.
struct SpheresItem {
  std::shared_ptr<const SphereSet> spheres;  ///< shared by frames
  std::uint32_t id = 0;                      ///< in the id picture; 0: none
  bool is_clipped = true;                    ///< the clip planes cut it
  bool operator==(const SpheresItem&) const = default;
};

/// All that one picture shows, how large, and from where.
struct FramePacket {
  View view;                                    ///< the eye
  std::vector<View> eyes{};                     ///< drawn one by one, each with the packet's size, and packed; empty: the view alone
  Packing packing = Packing::single;            ///< how the eyes' pictures make one
  std::uint32_t width = 1024, height = 768;     ///< pixels, of each eye
  std::array<float, 4> background{0, 0, 0, 1};  ///< alpha 0: transparent
  std::vector<VolumeItem> volumes;              ///< what rays go through
  std::vector<IsosurfaceItem> isosurfaces;      ///< surfaces that rays meet
  std::vector<MeshItem> meshes;                 ///< triangles
  std::vector<SliceItem> slices;                ///< planes through grids
  std::vector<TubeItem> tubes;                  ///< streamlines and curves
  std::vector<ArrowItem> arrows;                ///< their arrowheads
  std::vector<GlyphItem> glyphs;                ///< arrows at places
  std::vector<SpheresItem> spheres;             ///< points
  std::vector<CursorItem> cursors;              ///< hands
  std::vector<IndicatorItem> indicators;        ///< what the flow does at a hand
  Overlay overlay;                              ///< what is written over it
  std::vector<Plane> clip_planes;               ///< what all planes keep is drawn; at most kMaxClipPlanes
  std::vector<LightItem> lights;                ///< none: a headlight; at most kMaxLights
  std::optional<FogItem> fog;                   ///< none: no fog
  double vignette = 0;                          ///< 0..1: how far the picture narrows while the world moves around a person; 0: not at all
  EnvironmentItems environment;                 ///< boxes, axes, the ground
  WidgetItems widgets;                          ///< what the hand takes hold of
  std::optional<bool> jitter;                   ///< of rays; overrides RenderSettings::jitter
  std::vector<ObjectName> objects;              ///< what the ids stand for
  std::string omitted;                          ///< what of curves and points is not drawn, in words; empty: nothing

  /// The next id, from 1 on.
  std::uint32_t add_object(std::string kind, std::string name, std::string item = {}) {
    objects.push_back({std::uint32_t(objects.size() + 1), std::move(kind), std::move(name), std::move(item)});
    return objects.back().id;
  }
};

}  // namespace catena::render
