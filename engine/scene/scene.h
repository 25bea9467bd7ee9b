/// A scene: the world of entities and the few things there is one of. Read from a scene file or made for a bare data file.
/// Nothing is loaded before it is asked for: a field is loaded once, and only if something names it.
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/geometry/flow/curve.h"
#include "engine/scene/annotations.h"
#include "engine/scene/components.h"
#include "engine/scene/stereo.h"
#include "engine/schema/key.h"

namespace catena::scene {

/// The least size of a number of a scene, but 0: its squares and quotients are numbers, too, of a double and (lengths of the picture) of a
/// float.
inline constexpr double kMinSize = 1e-30;
/// The largest.
inline constexpr double kMaxSize = 1e30;

/// All of a scene. One thread, the frame's; a copy is a scene of its own that shares fields, meshes and curves.
struct Scene {
  std::string path;                           ///< the file that it was read from, as it was given
  std::vector<std::string> referenced_files;  ///< all that its text and the overrides name, as the scene opens them, read so far or not
  /// About what still reads, but is written in another way now: "FILE:LINE: ..."; of a data file: what it looks like.
  std::vector<std::string> notes;
  EntityStore entities;  ///< the entities: fields, what is drawn, links, widgets
  /// What was made from it, by the same entities: traced lines, sorted values, measured rulers, polylines for the eye. Nothing here is of
  /// the scene: it can be dropped, and is made again.
  EntityStore cache;
  Coupling coupling;                        ///< how the links make a force
  Workspace workspace;                      ///< how the hand lies in the world
  std::optional<json::Node> device;         ///< "device": its keys are read where the device is opened
  Camera camera;                            ///< the eye
  Stereo stereo;                            ///< the eyes and screens
  Background background;                    ///< behind all
  TimeLine time;                            ///< the step in time
  Annotations annotations;                  ///< what is written over the picture
  std::vector<ClipPlane> clip_planes;       ///< what of the world is left out
  std::optional<bool> jitter;               ///< of rays; not stated: by the quality
  std::optional<BoundingBox> bounding_box;  ///< none: not drawn
  std::optional<Axes> axes;                 ///< none: not drawn
  std::optional<Ground> ground;             ///< none: not drawn
  std::optional<Fog> fog;                   ///< none: no fog
  std::vector<Light> lights;                ///< none: a headlight
  std::string quality;                      ///< draft, balanced, reference, time=MS, error=E; empty: not stated
  TuningTargets tuning;                     ///< empty: none
  Entity cursor;                            ///< what the hand holds; has a Cursor
  double animation_phase = 0;               ///< of what moves along the streamlines; the fraction counts

  /// Curves already traced, keyed by field version, flow and seed: tubes and links share the object. Those that nothing holds any more are
  /// dropped as seeds move (lines.h), so that hours of it do not fill the memory.
  struct CurveKey {
    std::uint64_t field_version;  ///< Field::version()
    bool is_line_field;           ///< followed as a line field
    double min_speed, length;     ///< as in flow::Flow; world units, 0: 10 L
    std::array<double, 3> seed;   ///< world
    auto operator<=>(const CurveKey&) const = default;
  };
  std::map<CurveKey, flow::CurvePtr> traced_curves;  ///< curves that something holds, or held lately
};

/// "--field NAME=FILE[:GRID]": replaces the source of a named field, or adds one. Or a program gives the field itself.
struct FieldOverride {
  std::string name, file, grid;  ///< the field's name in the scene; the file; its grid, empty: the only one
  field::AnyField
      in_memory_field{};  ///< made by the program: `file` and `grid` are not looked at. Not a grid: drawn from samples of its bounds
};

/// "error=2,max_tick_us=5": a plan as the command line has it. The error begins with the words.
Result<TuningTargets> parse_tuning_targets(std::string_view words);

/// Reads and checks the whole file; every error names file, line and what was expected. Does not load fields, but every
/// file that it names must exist.
Result<Scene> read_scene(const std::string& path, const std::vector<FieldOverride>& overrides = {});
Result<Scene> parse_scene(std::string_view text, const std::string& path,
                          const std::vector<FieldOverride>& overrides =
                              {});  ///< The same of a text; `path` is where relative names begin, and what messages call it.
/// A bare data file: its (first usable) scalar grid as the kind of its data is best shown (first_look.h), a vector grid as streamlines,
/// a triangle mesh as it is, curves in the colours of their directions, points as balls; the camera is fitted to what can be seen. `colors`
/// may name a colour map and a range: a scalar grid is then a volume whose opacity follows the range, lines show the speed by them. `step`:
/// in time, at which it is looked at and shown.
Result<Scene> scene_for_file(const std::string& path, const std::string& grid = {}, const NamedColors& colors = {}, int step = 0);

/// The same of a grid that a program gives: the field "field" of the scene. An error where it is no grid, or has no finite value.
Result<Scene> scene_for_field(const field::AnyField& grid, const NamedColors& colors = {});

/// What such a file looks like at a step in time, and its steps.
struct FileSummary {
  std::vector<std::string> lines;  ///< what it looks like, and why, in one sentence; then what of it is not as it was
  TimeSteps steps;                 ///< of the file, or of the pattern
};
/// Of a file that cannot be shown nothing.
FileSummary summarize_file(const std::string& path, const std::string& grid = {}, int step = 0);

/// What a data file is shown as: by its ending, and where that leaves it open by what it holds: fields before surfaces, lines and points.
/// Of a pattern: its first file.
enum class FileKind { field, mesh, curves, points };
/// The kind of that file. It is looked into only where its ending leaves it open.
FileKind detect_file_kind(const std::string& path);

/// What a scene file may say, part by part (engine/schema): docs/scene.md, the JSON Schema and the reader are made of it. The links of
/// "chain" and the keys of "device" are described by the rooms that read them.
const std::vector<schema::Section>& scene_components();

/// The entity of that name among those that have a T.
template <class T>
Entity find_named(const Scene& scene, std::string_view name) {
  Entity found;
  scene.entities.each<T>([&](Entity e, const T&) {
    if (scene.entities.get<Name>(e).value == name) found = e;
  });
  return found;
}
/// The field of that name; none: an entity that is false.
inline Entity find_field(const Scene& scene, std::string_view name) { return find_named<FieldSource>(scene, name); }
/// The mesh of that name; none: an entity that is false.
inline Entity find_mesh(const Scene& scene, std::string_view name) { return find_named<MeshSource>(scene, name); }
/// The widget of that name; none: an entity that is false.
inline Entity find_widget(const Scene& scene, std::string_view name) { return find_named<Widget>(scene, name); }

/// Loads on first use. `where` is the place that names the field, for messages.
Result<field::AnyField> resolve_field(Scene& scene, Entity field, const json::Node& where);
/// The same by its name.
Result<field::AnyField> resolve_field(Scene& scene, const std::string& name, const json::Node& where);
/// The same as a grid that can be drawn (analytic fields are sampled once). Volumes over the field that state no colours or
/// no opacity get theirs from its histogram.
Result<field::AnyField> resolve_rendered_field(Scene& scene, Entity field, const json::Node& where);
/// Loads on first use: the hand's and the eye's mesh are one object.
Result<mesh::MeshPtr> resolve_mesh(Scene& scene, Entity mesh);
/// What has been loaded; empty where nothing has asked for it yet.
inline const field::AnyField& loaded_field(const Scene& scene, Entity field) { return scene.entities.get<FieldSource>(field).loaded; }
/// The grid that is drawn; empty where nothing has asked for it yet.
inline const field::AnyField& rendered_field(const Scene& scene, Entity field) { return scene.entities.get<FieldSource>(field).rendered; }
/// The same by its name.
Result<mesh::MeshPtr> resolve_mesh(Scene& scene, const std::string& name, const json::Node& where);
/// Curves from a file; loaded on first use.
Result<curves::CurveSetPtr> resolve_curves(Scene& scene, Entity curves);
/// The same by their name.
Result<curves::CurveSetPtr> resolve_curves(Scene& scene, const std::string& name, const json::Node& where);
/// The same of points from a table.
Result<curves::PointSetPtr> resolve_points(Scene& scene, Entity points);
/// The same by their name.
Result<curves::PointSetPtr> resolve_points(Scene& scene, const std::string& name, const json::Node& where);
/// The one curve of (field, flow, seed, length), while something holds it.
Result<flow::CurvePtr> resolve_streamline(Scene& scene, const flow::Flow& flow, const Vec3& seed, const json::Node& where,
                                          double length = 0);

/// The widget as the tick takes it: sizes that the scene does not state follow L, the longest edge of the domain boxes of the fields,
/// meshes, curves and points that the scene draws or the widget names (without any: of those that its links name; else 4). An isolevel's
/// field is loaded and its value set. `along` is left to the maker of the program, which knows the links. Completed once.
Result<widget::Spec> resolve_widget(Scene& scene, Entity widget);

/// Checks that a field that is loaded can have a surface: it is not read by its nearest voxels.
Outcome check_surface(const Scene& scene, Entity field, const json::Node& where);
/// Checks that a level can be drawn and felt: it lies within the field's values.
Outcome check_level(const field::ScalarField& field, double level, const json::Node& where);

}  // namespace catena::scene
