// SPDX-License-Identifier: MIT
/// A scene: entities with components, and the parts that exist once. Read from a scene file or created for a data file without a scene.
/// Data are loaded on first use only: a field is loaded once, and only if something refers to it.
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/result.h"
#include "engine/geometry/flow/curve.h"
#include "engine/scene/annotations.h"
#include "engine/scene/components.h"
#include "engine/scene/orthogonal_views.h"
#include "engine/scene/stereo.h"
#include "engine/schema/key.h"

namespace catena::scene {

/// Minimum size of a number in a scene, apart from 0: squares and quotients of such numbers remain normal doubles and, for lengths in the
/// image, normal floats.
inline constexpr double kMinSize = 1e-30;
/// Maximum size of a number in a scene.
inline constexpr double kMaxSize = 1e30;

/// A complete scene. Frame thread only. A copy is an independent scene that shares fields, meshes and curves.
struct Scene {
  std::string path;                           ///< Path it was read from, as it was given
  std::vector<std::string> referenced_files;  ///< All files that the text and the overrides name, as the scene opens them
  std::vector<std::string> known_files;       ///< Files that need not exist at the moment, see parse_scene()
  /// Messages: "FILE:LINE: ..." about problems of the loaded data, and for a data file the classification of its data.
  std::vector<std::string> notes;
  EntityStore entities;  ///< Fields, visible objects, links, widgets
  /// Derived data, with the same entities as `entities`: traced lines, sorted values, ruler results, polylines for rendering. Can be
  /// dropped at any time and is computed again on use.
  EntityStore cache;
  Coupling coupling;                                ///< Parameters of the force of the links
  Workspace workspace;                              ///< Mapping from the device's workspace to the world
  std::optional<json::Node> device;                 ///< Item "device"; its keys are read when the device is opened
  Camera camera;                                    ///< The camera
  Stereo stereo;                                    ///< Stereo mode, eye separation and screens
  Background background;                            ///< Background of the image
  TimeLine time;                                    ///< Current time step
  Annotations annotations;                          ///< Text and marks over the image
  std::vector<ClipPlane> clip_planes;               ///< Planes that cut the scene
  Vec3 stretch{1.0};                                ///< Factors by which images are stretched along the world's axes, > 0
  std::optional<OrthogonalViews> orthogonal_views;  ///< Planes beside the 3D view; empty: the window opens without them
  std::optional<bool> jitter;                       ///< Jitter of ray samples; empty: by `quality`
  std::optional<BoundingBox> bounding_box;          ///< Empty: not rendered
  std::optional<Axes> axes;                         ///< Empty: not rendered
  std::optional<Ground> ground;                     ///< Empty: not rendered
  std::optional<Fog> fog;                           ///< Empty: no fog
  Illumination illumination;                        ///< What lights the scene
  std::string quality;         ///< Image quality: draft, balanced, reference, time=MS, error=E or step=VOXELS; empty: not specified
  TuningTargets tuning;        ///< Targets stated by `quality` and "coupling"
  Entity cursor;               ///< Entity that has the Cursor component
  double animation_phase = 0;  ///< Phase of the animated bands of streamlines; only the fractional part is used

  /// Key of a traced curve: field version, flow and seed. Tubes and links share the curves. Curves without another owner are dropped as
  /// seeds move (drop_unused_curves, streamlines.h), which bounds the memory.
  struct CurveKey {
    std::uint64_t field_version;  ///< Field::version()
    bool is_line_field;           ///< Line field: v and -v are equivalent
    double min_speed, length;     ///< Minimum speed of flow::Flow; maximum length, world units, 0: 10 L
    std::array<double, 3> seed;   ///< World
    auto operator<=>(const CurveKey&) const = default;
  };
  std::map<CurveKey, flow::CurvePtr> traced_curves;  ///< Curves in use, or recently used

  /// Key of a traced path line: field, times, interpolation in time, number of steps, and seed. Tubes and links share the curves.
  struct PathKey {
    std::uint32_t field;          ///< Entity
    std::array<double, 2> times;  ///< Start and end
    double tolerance;             ///< Error of a step, relative to L; 0: the default
    bool is_cubic_in_time;        ///< Interpolation between the time steps
    std::size_t steps;            ///< Number of steps of the field; 0: a formula
    std::array<double, 3> seed;   ///< World
    auto operator<=>(const PathKey&) const = default;
  };
  std::map<PathKey, flow::CurvePtr> traced_paths;  ///< Path lines in use, or recently used
};

/// Replaces the source of a named field, or adds a field: the option "--field NAME=FILE[:GRID]", or a field that the calling program owns.
struct FieldOverride {
  std::string name, file, grid;  ///< Name of the field in the scene; file; grid of the file, empty: the only one
  /// Field of the calling program; if set, `file` and `grid` are ignored. A field that is no grid is sampled within its bounds for images.
  field::AnyField in_memory_field{};
};

/// Returns the targets of an image quality "error=E" or "time=MS"; none for the other qualities, which are fixed settings.
CATENA_EXPORT TuningTargets image_targets(std::string_view quality);

/// Reads and checks a whole scene file. Fields are not loaded, but every file that the scene names must exist. Error: file, line and what
/// was expected.
CATENA_EXPORT Result<Scene> read_scene(const std::string& path, const std::vector<FieldOverride>& overrides = {});
/// Parses and checks the text of a scene file; relative file names start at the folder of `path`, which also names the text in messages.
/// `known_files`: files that need not exist at the moment, because the scene has named them before.
CATENA_EXPORT Result<Scene> parse_scene(std::string_view text, const std::string& path, const std::vector<FieldOverride>& overrides = {},
                                        const std::vector<std::string>& known_files = {});
/// Creates the scene of a data file. Scalar grids are shown by the kind of data (default_visualization.h), vector grids as streamlines,
/// triangle meshes as they are, curves in the colors of their directions, points as balls; the camera is fitted. `grid`: the grid to show;
/// empty: the first usable scalar grid, else the first vector grid. `colors` may specify a color map and a range: a scalar grid is then a
/// volume whose opacity follows the range, and lines are colored by speed. `step`: time step that is analyzed and shown.
CATENA_EXPORT Result<Scene> scene_for_file(const std::string& path, const std::string& grid = {}, const FileColors& colors = {},
                                           int step = 0);

/// Creates the scene of a grid of the calling program, which becomes the field "field". Error: it is no grid, or has no finite value.
CATENA_EXPORT Result<Scene> scene_for_field(const field::AnyField& grid, const FileColors& colors = {});

/// Description of a data file at a time step.
struct FileSummary {
  std::vector<std::string> lines;  ///< Classification of the data with its reason, in one sentence; then notes on the loaded data
  TimeSteps steps;                 ///< Time steps of the file or pattern
};
/// Returns the description; empty for a file that cannot be shown.
CATENA_EXPORT FileSummary summarize_file(const std::string& path, const std::string& grid = {}, int step = 0);

/// Kind of object as which a data file is shown. If the extension of the file name allows several, the content decides: fields before
/// surfaces, lines and points. For a pattern its first file counts.
enum class FileKind { field, mesh, curves, points };
/// Returns the kind of a file. Opens the file only if its extension allows several kinds.
CATENA_EXPORT FileKind detect_file_kind(const std::string& path);

/// Returns the sections of the scene file (engine/schema), from which docs/reference/scene.md, the JSON Schema and the reader are made. The
/// modules that read the links of "chain" and the keys of "device" describe them.
CATENA_EXPORT const std::vector<schema::Section>& scene_components();

/// Returns the entity of that name among those that own a T; none: an entity that is false.
template <class T>
Entity find_named(const Scene& scene, std::string_view name) {
  Entity found;
  scene.entities.each<T>([&](Entity e, const T&) {
    if (scene.entities.get<Name>(e).value == name) found = e;
  });
  return found;
}
/// Returns the field of that name; none: an entity that is false.
inline Entity find_field(const Scene& scene, std::string_view name) { return find_named<FieldSource>(scene, name); }
/// Returns the mesh of that name; none: an entity that is false.
inline Entity find_mesh(const Scene& scene, std::string_view name) { return find_named<MeshSource>(scene, name); }
/// Returns the widget of that name; none: an entity that is false.
inline Entity find_widget(const Scene& scene, std::string_view name) { return find_named<Widget>(scene, name); }

/// Returns the field, loading it on first use. `where`: node that names the field, for messages. Error: it cannot be loaded.
CATENA_EXPORT Result<field::AnyField> resolve_field(Scene& scene, Entity field, const json::Node& where);
/// Returns the field of that name, loading it on first use; an Error lists the known names.
CATENA_EXPORT Result<field::AnyField> resolve_field(Scene& scene, const std::string& name, const json::Node& where);
/// Returns the field as a grid for images; an analytic field is sampled once. Completes the colors and opacities of volumes over the field
/// from its histogram (auto_transfer.h). Error: it cannot be loaded or sampled, or is too far from the origin.
CATENA_EXPORT Result<field::AnyField> resolve_rendered_field(Scene& scene, Entity field, const json::Node& where);
/// Returns the mesh, loading it on first use; rendering and haptics share it.
CATENA_EXPORT Result<mesh::MeshPtr> resolve_mesh(Scene& scene, Entity mesh);
/// Returns the field if it is loaded, else an empty one.
inline const field::AnyField& loaded_field(const Scene& scene, Entity field) { return scene.entities.get<FieldSource>(field).loaded; }
/// Returns the grid for images if it exists, else an empty one.
inline const field::AnyField& rendered_field(const Scene& scene, Entity field) { return scene.entities.get<FieldSource>(field).rendered; }
/// Returns the mesh of that name, loading it on first use.
CATENA_EXPORT Result<mesh::MeshPtr> resolve_mesh(Scene& scene, const std::string& name, const json::Node& where);
/// Returns curves from a file, loading them on first use, or the vortex core curves of a field.
CATENA_EXPORT Result<curves::CurveSetPtr> resolve_curves(Scene& scene, Entity curves);
/// Returns the curves of that name, loading them on first use; an Error lists the known names.
CATENA_EXPORT Result<curves::CurveSetPtr> resolve_curves(Scene& scene, const std::string& name, const json::Node& where);
/// Returns points from a table, loading them on first use.
CATENA_EXPORT Result<curves::PointSetPtr> resolve_points(Scene& scene, Entity points);
/// Returns the points of that name, loading them on first use; an Error lists the known names.
CATENA_EXPORT Result<curves::PointSetPtr> resolve_points(Scene& scene, const std::string& name, const json::Node& where);
/// Returns the streamline through a seed; `length`: maximum arc length in each direction, world units, 0: 10 L. While it is in use, all
/// callers get the same object. Error, at `where`: the seed starts no line.
CATENA_EXPORT Result<flow::CurvePtr> resolve_streamline(Scene& scene, const flow::Flow& flow, const Vec3& seed, const json::Node& where,
                                                        double length = 0);

/// Returns the widget for the haptic program. Sizes that the scene does not specify are set from L, the longest edge of the domain boxes of
/// all fields, meshes, curves and points that the scene renders or the widget names (if there are none: of the fields that links name;
/// else 4). Loads the field of an isolevel and sets its value. `along_links` is left to the builder of the program. Computed once.
CATENA_EXPORT Result<widget::Spec> resolve_widget(Scene& scene, Entity widget);

/// Checks that a loaded field can have isosurfaces. Error: it uses nearest-voxel interpolation.
CATENA_EXPORT Outcome check_surface(const Scene& scene, Entity field, const json::Node& where);
/// Checks that a level lies within the field's values, so that it can be rendered and be in haptic contact.
CATENA_EXPORT Outcome check_level(const field::ScalarField& field, double level, const json::Node& where);

}  // namespace catena::scene
