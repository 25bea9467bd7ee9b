/// The components: plain structs that say what an entity is. Field's terms; world units; display (sRGB) colours as written.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/json.h"
#include "engine/field/analytic.h"
#include "engine/field/load.h"
#include "engine/mesh/load.h"
#include "engine/scene/world.h"

namespace catena::scene {

struct Name {
  std::string value;
};

/// A field of the scene: where it comes from, and the field itself once something has asked for it.
struct FieldSource {
  json::Node where;                        ///< its place in the scene file, for messages
  std::optional<field::LoadRequest> file;  ///< either this
  bool grid_is_a_wish = false;             ///< a replaced file may lack the grid that the first one had
  std::string analytic;                    ///< or this
  field::AnalyticParameters parameters;
  int resolution = 128;  ///< analytic fields are drawn from a sampled grid: nodes an axis
  std::array<double, 2> box{-2, 2};
  field::AnyField loaded;  ///< exact (the hand's)
  field::AnyField drawn;   ///< a grid (the eye's); the same object for files
};

struct Rgb {
  float r = 0, g = 0, b = 0;
};

/// Piecewise-linear maps over field values, values rising. The scene gives either extinctions (sigma per world unit) or
/// opacities (alpha per opacity_unit), which become sigma = -ln(1 - alpha) / opacity_unit at their points once the drawn
/// grid is known (its smallest voxel edge is the default unit). Between the points sigma is linear.
struct TransferFunction {
  struct ColorPoint {
    double value;
    Rgb color;
  };
  struct ExtinctionPoint {
    double value, sigma;
  };
  struct OpacityPoint {
    double value, alpha;
  };
  std::vector<ColorPoint> colors;
  std::vector<OpacityPoint> opacities;
  double opacity_unit = 0;  ///< world length; 0: the smallest voxel edge of the drawn grid
  std::vector<ExtinctionPoint> extinctions;
};

struct Volume {
  Entity field;
  json::Node where;
  TransferFunction transfer;
  bool shade = false;
};

struct Isosurface {
  Entity field;
  json::Node where;
  double level = 0;
  Rgb color{0.8f, 0.8f, 0.9f};
  double opacity = 1;
};

/// A triangle mesh of the scene: where it comes from, and the mesh itself once something has asked for it.
struct MeshSource {
  json::Node where;
  std::string path;
  mesh::Placement placement;  ///< world = scale * file + offset
  mesh::MeshPtr loaded;       ///< felt and drawn: one object
};

/// A mesh that is drawn.
struct SurfaceMesh {
  Entity mesh;
  json::Node where;
  Rgb color{0.8f, 0.8f, 0.9f};
};

struct StreamlineSet {
  Entity field;
  json::Node where;
  std::vector<Vec3> seeds;
  double radius = 0;  ///< 0: fitted to the domain
  Rgb color{1.0f, 0.3f, 0.2f};
  bool line = false;  ///< "kind": "line"
  double min_speed = 0;
  double length = 0;  ///< 0: 10 L, each direction
};

/// The cursor: what the hand holds, as the last tick left it. Written by the cursor system, drawn as a glyph.
struct Cursor {
  Vec3 probe{0.0};
  std::vector<Vec3> proxies;
  std::vector<bool> active;
  std::vector<double> leaving;  ///< by link: 0 on its feature .. 1 where the hand has left it
  Vec3 force_n{0.0};
  double size = 0;  ///< glyph radius, world units; 0: fitted
  bool visible = false;
};

/// One link of the chain; its own keys are read by the constraint that it names.
struct Link {
  std::string name, type;
  json::Node node;
};

/// A mode of operation: while its switch is on, these links run in this order. The switch is read by haptics/extract.
struct Mode {
  std::string name;
  std::vector<std::string> links;
  json::Node node;
};

/// How the links make one force: the chain, or a baseline of the paper (haptics/chain/baseline.h).
enum class CouplingMethod { chain, pipe, balance, closest, linear };

struct Coupling {
  double stiffness_n_per_m = 500;
  double damping_ns_per_m = 0;
  double max_force_n = 8;
  std::optional<double> ramp_s;
  double rotational_stiffness_nm_per_rad = 0.5;
  double rotational_damping_nms_per_rad = 0;
  CouplingMethod method = CouplingMethod::chain;
};

struct Workspace {
  double metres_per_unit = 1;
  Vec3 origin{0.0};
  Mat3 rotation{1.0};  ///< world from hand
  bool given = false;
};

struct Camera {
  Vec3 position{0.0, -8.0, 3.0}, target{0.0}, up{0.0, 0.0, 1.0};
  double fovy_deg = 30;
  bool orthographic = false;
  double height = 1;   ///< orthographic: world units from bottom to top
  bool given = false;  ///< false: fitted to what is drawn
};

struct Background {
  Rgb color{0, 0, 0};
  bool transparent = false;
};

}  // namespace catena::scene
