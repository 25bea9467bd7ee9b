// SPDX-License-Identifier: MIT
/// Frame packet: everything one image needs, as plain data. render/extract copies it from the scene; the ECS is not read afterwards. Fields
/// are held by shared pointer (kept alive while the frame uses them); their values are not read in this header.
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
#include "engine/base/threshold.h"
#include "engine/base/vec.h"
#include "render/frame/overlay_items.h"
#include "render/frame/packing.h"

namespace catena::field {
class PagedGrid;
class ScalarGrid;
}  // namespace catena::field
namespace catena::flow {
struct LicTexture;
}

namespace catena::render {

/// Rectangle in the image plane of a view, relative to its symmetric frustum and possibly beyond it, in units of the frustum's half
/// extents: for off-axis (stereo) projection or for a tile of a large image.
struct FrustumWindow {
  double left = -1, right = 1, bottom = -1, top = 1;  ///< -1 and 1 are the edges of the symmetric frustum
  bool operator==(const FrustumWindow&) const = default;
};

/// Viewpoint and projection of a camera. Display units: world units times `stretch`, axis by axis.
struct View {
  Vec3 position{0.0}, target{0.0}, up{0.0, 0.0, 1.0};  ///< camera position; point it looks at; up direction
  double fovy_deg = 30;                                ///< vertical field of view, degrees
  bool orthographic = false;                           ///< orthographic projection instead of perspective
  double height = 1;                                   ///< orthographic: world units from bottom to top of the image
  FrustumWindow window{};                              ///< rendered part of the frustum
  double aspect = 0;                                   ///< width / height of the symmetric frustum; 0: such that pixels are square
  Vec3 stretch{1.0};  ///< factors along the world's axes, > 0, by which the image is stretched before it is seen
  bool operator==(const View&) const = default;
};

/// Directional light (infinitely far away), in world axes or in view axes: right, up, towards the camera.
struct LightItem {
  Vec3 direction{0.0, 0.0, 1.0};  ///< direction towards the light
  Color color{1, 1, 1};           ///< color times intensity
  bool camera_relative = false;   ///< `direction` is in view axes
  double angular_size_deg = 0;    ///< diameter as seen from the scene, degrees; makes shadows soft
  bool operator==(const LightItem&) const = default;
};

/// Light from all sides, and what `lights` cast.
struct IlluminationItem {
  Color sky{0.2f, 0.2f, 0.2f}, ground{0.2f, 0.2f, 0.2f};  ///< light from above (+z) and from below; in between they are mixed
  double occlusion_reach = 0;                             ///< an occluder at this distance counts by 1/e, display units; 0: no occlusion
  double occlusion_strength = 1;                          ///< share of the occlusion that is applied
  /// Light is added in linear radiance and converted to the display encoding at the end. The colors of fog, volumes, isosurfaces
  /// and slices are linear then (render/extract/linear_colors.h). False: it is added in the display encoding.
  bool is_linear = false;
  bool shadows = false;  ///< the first kMaxShadows lights cast shadows, if they are fixed in the world
  Bounds bounds{};       ///< of what casts shadows, display units
  /// Returns whether the environment is the default one.
  bool is_default() const { return sky == IlluminationItem{}.sky && ground == IlluminationItem{}.ground; }
  /// Returns whether items darken each other.
  bool is_cast() const { return occlusion_reach > 0 || shadows; }
  /// Compares all members.
  bool operator==(const IlluminationItem& other) const {
    return sky == other.sky && ground == other.ground && occlusion_reach == other.occlusion_reach &&
           occlusion_strength == other.occlusion_strength && is_linear == other.is_linear && shadows == other.shadows &&
           bounds.lo == other.bounds.lo && bounds.hi == other.bounds.hi;
  }
};
/// Largest number of lights that cast shadows.
inline constexpr std::size_t kMaxShadows = 3;

/// Depth fog: its opacity is 0 up to the view depth `near` and max_opacity from `far` on.
struct FogItem {
  Color color;                                  ///< fog color
  double near = 0, far = 1, max_opacity = 0.8;  ///< view depths where the fog begins and where it is densest, world units; opacity at `far`
  bool operator==(const FogItem&) const = default;
};

/// Scene object of an id in the id image.
struct ObjectName {
  std::uint32_t id = 0;      ///< value in the id image, 1 or greater
  std::string kind, name;    ///< kind of object, for instance "isosurface"; name in the scene
  std::string scene_path{};  ///< path in the scene file, for instance "isosurfaces[1]"; empty: not an item of a list
};

/// Returns column `column` of `points` (rows of value, columns.., values not falling) at `value`: linear between the points, constant
/// beyond them, 0 without points. Of two points at the same value, the later one holds from that value on.
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

/// Transfer function, piecewise linear over field values: color and extinction coefficient sigma (per world unit).
struct TransferTable {
  std::vector<std::array<double, 4>> colors;       ///< value, r, g, b
  std::vector<std::array<double, 2>> extinctions;  ///< value, sigma
  /// Gradient magnitude (field units per world unit) and factor 0..1 that multiplies sigma; empty: factor 1 everywhere.
  std::vector<std::array<double, 2>> gradient_factors;
  double opacity_length = 0;    ///< opacity reference length of projections, world units; 0: smallest voxel edge
  bool is_categorical = false;  ///< values are whole numbers (labels), each with its own appearance
  /// Linear threshold of the symlog scale (engine/base/symlog_scale.h) on which lookup tables of this function are sampled evenly: the
  /// points must lie close together on that scale. 0: linear scale.
  double linear_below = 0;
  bool operator==(const TransferTable&) const = default;
};

/// Projection of the values along a ray to one color.
///   composite   emission and absorption
///   maximum     color and opacity, over the table's opacity_length, of the maximum value along the ray; minimum: of the minimum
///   average     color and opacity, over the table's opacity_length, of the mean value
enum class Projection { composite, maximum, minimum, average };

/// Coloring by another field, sampled at the same world position. Where that field has no value, the item's own color is used.
struct ColorSource {
  std::shared_ptr<const field::ScalarGrid> grid;  ///< field that gives the colors
  std::vector<std::array<double, 4>> colors;      ///< value, r, g, b
  bool is_categorical = false;   ///< values are whole numbers (labels), each with its own color; 0 is no label and has no color
  bool spread_labels = false;    ///< if the nearest voxel has no color: that of the nearest voxel of the cell that has one
  double linear_below = 0;       ///< as in TransferTable
  std::vector<double> labels{};  ///< labels that have a color, rising; empty: all but 0
  bool operator==(const ColorSource&) const = default;
};

/// How a volume scatters light; of FramePacket::illumination with linear radiance.
struct Scattering {
  double albedo = 1;      ///< factor on the color, 0 to 1; already applied to the transfer function's colors
  double anisotropy = 0;  ///< g of Henyey and Greenstein's phase function, > -1 and < 1; > 0: forwards
  double surface = 1;     ///< shaded volumes: share that is reflected by the gradient; the rest is scattered by the phase function
  bool operator==(const Scattering&) const = default;
};

/// Volume to be rendered by ray casting.
struct VolumeItem {
  std::shared_ptr<const field::ScalarGrid> grid;  ///< scalar field
  TransferTable transfer;                         ///< colors and extinctions
  bool is_shaded = false;                         ///< shaded by the gradient
  std::uint32_t id = 0;                           ///< id in the id image; 0: none
  bool is_clipped = true;                         ///< cut by the clip planes
  Projection projection = Projection::composite;  ///< projection of the values along a ray
  std::optional<ColorSource> color_by{};          ///< color by another field; composite only
  /// Finest level of the data of which `grid` is a coarser one, drawn by the fast raycast; null: `grid` is all.
  std::shared_ptr<const field::PagedGrid> paged{};
  Scattering scattering{};  ///< how it scatters light
  bool operator==(const VolumeItem&) const = default;
};

/// Isosurface to be rendered by ray casting.
struct IsosurfaceItem {
  std::shared_ptr<const field::ScalarGrid> grid;  ///< scalar field
  double level = 0;                               ///< isovalue
  Color color;                                    ///< color where color_by gives none
  float opacity = 1;                              ///< opacity of one crossing of the surface, 0 to 1
  std::uint32_t id = 0;                           ///< id in the id image; 0: none
  bool is_clipped = true;                         ///< cut by the clip planes
  std::optional<ColorSource> color_by{};          ///< color by another field; nullopt: `color` everywhere
  /// Finest level of the data of which `grid` is a coarser one; null: `grid` is all. Translucent surfaces, and those with `color_by`, are
  /// drawn from `grid`.
  std::shared_ptr<const field::PagedGrid> paged{};
  bool operator==(const IsosurfaceItem&) const = default;
};

/// Triangle mesh, as the haptic proxies touch it. Built once per mesh and shared by frames.
struct MeshGeometry {
  std::vector<Vec3> vertices;            ///< positions, world units
  std::vector<std::uint32_t> triangles;  ///< three indices each, counter-clockwise from outside
  std::vector<Vec3> normals{};           ///< one per vertex, for smooth shading; may be empty if smooth shading is not used
  std::vector<Color> colors{};           ///< one per vertex; empty: color of the item everywhere
  bool operator==(const MeshGeometry&) const = default;
};

/// Triangle mesh to be rendered.
struct MeshItem {
  std::shared_ptr<const MeshGeometry> geometry;  ///< shared by frames
  Color color;                                   ///< color of vertices without a color of their own
  std::uint32_t id = 0;                          ///< id in the id image; 0: none
  bool is_clipped = true;                        ///< cut by the clip planes
  float opacity = 1;                             ///< opacity of one side; < 1: rendered in the translucent layers
  bool smooth = false;                           ///< shaded by vertex normals instead of flat triangle normals
  bool show_edges = false;                       ///< show the triangle edges as lines
  /// Compares the triangles by value, even if they are stored in different objects.
  bool operator==(const MeshItem& other) const {
    const bool alike = geometry == other.geometry || (geometry && other.geometry && *geometry == *other.geometry);
    return alike && color == other.color && id == other.id && is_clipped == other.is_clipped && opacity == other.opacity &&
           smooth == other.smooth && show_edges == other.show_edges;
  }
};

/// Slice plane through a grid, colored by its values. Contour lines are drawn on it, opaque even if the slice is translucent.
struct SliceItem {
  std::shared_ptr<const field::ScalarGrid> grid;  ///< scalar field
  Vec3 point{0.0}, normal{0.0, 0.0, 1.0};         ///< point on the plane and its normal, world axes; the normal need not be a unit vector
  std::vector<std::array<double, 4>> colors;      ///< value, r, g, b; piecewise linear
  float opacity = 1;                              ///< < 1: rendered in the translucent layers
  bool lit = false;                               ///< shaded; false: the unshaded colors of the values
  std::vector<double> contour_levels{};           ///< values of the contour lines, rising
  Color line_color{0, 0, 0};                      ///< color of the contour lines
  float line_width = 1;                           ///< width of the contour lines, pixels
  std::uint32_t id = 0;                           ///< id in the id image; 0: none
  bool is_clipped = true;                         ///< cut by the clip planes
  int stack_order = 0;                            ///< number of earlier slices in the same plane; this slice is drawn over them
  std::optional<double> hidden_label{};           ///< label that is transparent: values within 0.5 of it are not drawn
  Threshold threshold{};                          ///< values that are drawn
  /// Finest level of the data of which `grid` is a coarser one; null: `grid` is all.
  std::shared_ptr<const field::PagedGrid> paged{};
  std::shared_ptr<const flow::LicTexture> texture{};  ///< line integral convolution in the plane; null: none
  float texture_strength = 0;                         ///< contrast of the texture, 0 to 1
  float texture_phase = 0;                            ///< phase of an animated texture; only the fractional part is used
  bool operator==(const SliceItem&) const = default;
};

/// Tube around a polyline, which is flattened from the curve finely enough for the radius.
struct TubeItem {
  SharedList<Vec3> points;     ///< vertices of the polyline, world units; a single point gives a sphere
  double radius = 0;           ///< world units
  Color color;                 ///< color of points without a color of their own
  SharedList<Color> colors{};  ///< one per point; empty: `color` everywhere
  std::uint32_t id = 0;        ///< id in the id image; 0: none
  bool is_clipped = true;      ///< cut by the clip planes
  bool operator==(const TubeItem&) const = default;
};

/// Arrowhead: a cone.
struct ArrowItem {
  Vec3 base{0.0}, tip{0.0};  ///< center of the base; apex; world units
  double radius = 0;         ///< radius of the base, world units
  Color color;               ///< color of the cone
  std::uint32_t id = 0;      ///< id in the id image; 0: none
  bool is_clipped = true;    ///< cut by the clip planes
  bool operator==(const ArrowItem&) const = default;
};

/// One arrow of a vector field.
struct Glyph {
  Vec3 tail{0.0}, tip{0.0};  ///< start and end, world units
  Color color;               ///< color of the arrow
  bool operator==(const Glyph&) const = default;
};

/// Arrows of one shape: a cylinder and a cone, whose sizes are proportional to the length of each arrow.
struct GlyphItem {
  SharedList<Glyph> glyphs;    ///< arrows of this shape
  double shaft_radius = 0.06;  ///< radius of the cylinder, as a fraction of the arrow's length
  double head_length = 0.36;   ///< length of the cone, as a fraction of the arrow's length; 0: no cone, the cylinder reaches the tip
  double head_radius = 0.144;  ///< radius of the cone's base, as a fraction of the arrow's length
  std::uint32_t id = 0;        ///< id in the id image; 0: none
  bool is_clipped = true;      ///< cut by the clip planes
  bool operator==(const GlyphItem&) const = default;
};

/// Local flow indicator: a short segment of the streamline through the cursor, with an arrowhead downstream.
struct IndicatorItem {
  TubeItem tube;    ///< streamline segment
  ArrowItem arrow;  ///< arrowhead downstream
  bool operator==(const IndicatorItem&) const = default;
};

/// Haptic cursor: the probe, the proxy of every link, the links between them, and the force. Not cut by clip planes.
struct CursorItem {
  Vec3 probe{0.0};                     ///< probe position, world units
  std::vector<Vec3> proxies;           ///< one per link, world units
  std::vector<bool> link_active;       ///< one per link: the link is active
  Vec3 force_n{0.0};                   ///< force in world axes, newtons
  double radius = 0;                   ///< radius of the probe sphere, world units
  std::vector<double> release_ratios;  ///< one per link: 0 on its feature .. 1 where it is released; empty: all 0
  std::uint32_t id = 0;                ///< id in the id image; 0: none
  /// Force as a fraction of the maximum, 0..1, for devices without force output (a mouse), where the image conveys the force: the cursor is
  /// the last proxy, the probe is a small sphere on a tether whose color and width show the force. nullopt: normal cursor.
  std::optional<double> force_ratio{};
  bool show_occluded = true;         ///< x-ray overlay: occluded parts shine through
  bool is_crosshair = false;         ///< crosshair of three bars along the axes, each 2 * radius long; no proxies, no force
  std::optional<Vec3> foot_point{};  ///< foot point: a thin line leads from the probe to it and ends in a cross perpendicular to the line
  bool operator==(const CursorItem&) const = default;
};

/// Environment of the data: bounding boxes, axes, the ground. The camera is not fitted to them; clip planes do not cut them.
struct EnvironmentItems {
  std::vector<TubeItem> tubes;   ///< edges
  std::vector<MeshItem> meshes;  ///< faces
  /// Returns whether there are no items.
  bool empty() const { return tubes.empty() && meshes.empty(); }
  bool operator==(const EnvironmentItems&) const = default;
};

/// Interactive widgets (paper, Figure 6). A tube of a single point is a sphere. The camera is not fitted to them.
struct WidgetItems {
  std::vector<TubeItem> tubes;    ///< edges and handles
  std::vector<ArrowItem> arrows;  ///< arrowheads
  std::vector<MeshItem> meshes;   ///< faces
  /// Returns whether there are no items.
  bool empty() const { return tubes.empty() && arrows.empty() && meshes.empty(); }
  bool operator==(const WidgetItems&) const = default;
};

/// Set of spheres at points. Built once per set and shared by frames.
struct SphereSet {
  Vec3 origin{0.0};                ///< origin of the offsets, world units
  std::vector<glm::vec3> offsets;  ///< positions minus `origin`
  std::vector<float> radii;        ///< one per sphere, world units
  std::vector<Color> colors;       ///< one per sphere
  Bounds robust_bounds{};          ///< bounds without outliers, to which the automatic camera is fitted; empty: use all positions
  Vec3 position(std::size_t i) const { return origin + Vec3(offsets[i]); }  ///< world position of sphere i
};

/// Set of spheres to be rendered.
struct SpheresItem {
  std::shared_ptr<const SphereSet> spheres;  ///< shared by frames
  std::uint32_t id = 0;                      ///< id in the id image; 0: none
  bool is_clipped = true;                    ///< cut by the clip planes
  bool operator==(const SpheresItem&) const = default;
};

/// Everything one image shows, its size and its viewpoint. Positions and sizes of all items are in display units: where these headers say
/// world, the world times view.stretch.
struct FramePacket {
  View view;                 ///< camera
  std::vector<View> eyes{};  ///< views rendered one by one, each at the packet's size, then packed into one image; empty: only `view`
  Packing packing = Packing::single;  ///< packing of the images of `eyes`, or of this packet and `planes`, into one
  /// Packets of the same size, shown beside this one with Packing::grid: views of planes through the data. Without eyes.
  std::vector<std::shared_ptr<const FramePacket>> planes{};
  std::uint32_t width = 1024, height = 768;     ///< size of each view, pixels
  std::array<float, 4> background{0, 0, 0, 1};  ///< alpha 0: transparent
  std::vector<VolumeItem> volumes;              ///< rendered by ray casting
  std::vector<IsosurfaceItem> isosurfaces;      ///< rendered by ray casting
  std::vector<MeshItem> meshes;                 ///< triangle meshes
  std::vector<SliceItem> slices;                ///< slice planes through grids
  std::vector<TubeItem> tubes;                  ///< streamlines and curves
  std::vector<ArrowItem> arrows;                ///< arrowheads of streamlines and curves
  std::vector<GlyphItem> glyphs;                ///< arrows of vector fields
  std::vector<SpheresItem> spheres;             ///< point sets
  std::vector<CursorItem> cursors;              ///< haptic cursors
  std::vector<IndicatorItem> indicators;        ///< local flow indicators at the cursors
  Overlay overlay;                              ///< text and marks over the image
  std::vector<Plane> clip_planes;               ///< a point is visible if it is inside all of them; at most kMaxClipPlanes
  std::vector<LightItem> lights;                ///< empty: a headlight; at most kMaxLights
  IlluminationItem illumination;                ///< environment's light, occlusion, shadows
  bool has_line_halos = false;                  ///< streamlines and curves darken what is behind them, beside them
  std::optional<FogItem> fog;                   ///< none: no fog
  double vignette = 0;  ///< strength of the vignette that reduces the peripheral view while the view moves around the user, 0..1; 0: off
  EnvironmentItems environment;     ///< bounding boxes, axes, the ground
  WidgetItems widgets;              ///< interactive widgets
  std::optional<bool> jitter;       ///< jitter of the ray starts; overrides RenderSettings::jitter; nullopt: the settings apply
  std::vector<ObjectName> objects;  ///< objects by id
  double size_scale = 1;            ///< display units per world unit of sizes without a direction, such as radii
  std::string omitted;              ///< message about curves and points that are not rendered; empty: all are

  /// Number of views in the image; 0: only `view`.
  std::size_t view_count() const { return planes.empty() ? eyes.size() : planes.size() + 1; }
  /// Returns the packet of the first view alone.
  FramePacket first_view() const {
    FramePacket one = *this;
    if (!eyes.empty()) one.view = eyes.front();
    one.eyes.clear();
    one.planes.clear();
    one.packing = Packing::single;
    return one;
  }

  /// Appends an object and returns its id (1 for the first one). `item` is the path in the scene.
  std::uint32_t add_object(std::string kind, std::string name, std::string item = {}) {
    objects.push_back({std::uint32_t(objects.size() + 1), std::move(kind), std::move(name), std::move(item)});
    return objects.back().id;
  }
};

}  // namespace catena::render
