/// catena trace SCENE|FILE --field NAME --seeds CSV -o LINES.{csv,vtp}
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <map>
#include <memory>

#include "engine/app/command.h"
#include "engine/base/csv_paths.h"
#include "engine/base/numbers.h"
#include "engine/base/output_file.h"
#include "engine/field/load.h"

namespace catena::app {

namespace {

struct Options {
  std::string source, field, seeds, output, kind = "vector";
  double length = 0, min_speed = 0;
};

Result<field::VectorFieldPtr> vector_field(const Options& options, std::vector<std::string>& inputs) {
  field::AnyField any;
  if (is_scene_file(options.source)) {
    CATENA_TRY(scene::Scene scene, open_scene(options.source));
    inputs = inputs_of(scene);
    json::Node where;
    where.file = std::make_shared<const std::string>(options.source);
    const scene::Entity entity = scene::find_field(scene, options.field);
    if (!entity) {
      std::string known;
      scene.world.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource&) {
        known += (known.empty() ? "" : ", ") + scene.world.get<scene::Name>(e).value;
      });
      return Error{options.source + ": no field \"" + options.field + "\"; known: " + (known.empty() ? "none" : known)};
    }
    where = scene.world.get<scene::FieldSource>(entity).where;
    CATENA_TRY(any, scene::use_field(scene, entity, where));
  } else {
    inputs = {options.source};
    field::LoadRequest request;
    request.path = options.source;
    request.grid = options.field;
    CATENA_TRY(any, field::load(request));
  }
  if (!any.vector) return Error{options.source + ": field \"" + options.field + "\" is a scalar field: expected a vector field to trace"};
  return any.vector;
}

void append_csv(OutputFile& out, std::size_t line, const flow::Curve& curve) {
  std::string row;
  for (const flow::Knot& knot : curve.knots()) {
    row = std::to_string(line);
    for (const double x : {knot.s, knot.p.x, knot.p.y, knot.p.z, knot.t.x, knot.t.y, knot.t.z}) {
      row += ',';
      append_text(row, x);
    }
    row += '\n';
    out.write(row);
  }
}

// VTK's XML PolyData, ASCII: one polyline a curve, arc length and tangent as point data.
void write_vtp(OutputFile& out, const std::vector<flow::CurvePtr>& curves) {
  std::size_t points = 0;
  for (const auto& curve : curves) points += curve->knots().size();
  out.write("<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n<PolyData>\n");
  out.write(fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n",
                        points, curves.size()));
  const auto array = [&](const char* name, int components, const auto& values_of) {
    out.write(fmt::format("<DataArray type=\"Float64\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">\n", name, components));
    for (const auto& curve : curves)
      for (const flow::Knot& knot : curve->knots()) out.write(values_of(knot) + "\n");
    out.write("</DataArray>\n");
  };
  const auto text = [](const Vec3& v) { return to_text(v.x) + " " + to_text(v.y) + " " + to_text(v.z); };
  out.write("<PointData Scalars=\"s\" Vectors=\"tangent\">\n");
  array("s", 1, [](const flow::Knot& k) { return to_text(k.s); });
  array("tangent", 3, [&](const flow::Knot& k) { return text(k.t); });
  out.write("</PointData>\n<Points>\n");
  array("Points", 3, [&](const flow::Knot& k) { return text(k.p); });
  out.write("</Points>\n<Lines>\n<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n");
  for (std::size_t i = 0; i < points; ++i) out.write(std::to_string(i) + "\n");
  out.write("</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n");
  std::size_t offset = 0;
  for (const auto& curve : curves) out.write(std::to_string(offset += curve->knots().size()) + "\n");
  out.write("</DataArray>\n</Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n");
}

Outcome trace_lines(const Options& options) {
  if (!std::isfinite(options.length) || !std::isfinite(options.min_speed))
    return Error{"--length and --min-speed: expected finite numbers"};
  const bool vtp = options.output.ends_with(".vtp");
  if (!vtp && !options.output.ends_with(".csv") && !options.output.starts_with("/dev/"))
    return Error{options.output + ": expected an output that ends in .csv or .vtp"};
  std::vector<std::string> inputs;
  CATENA_TRY(const field::VectorFieldPtr field, vector_field(options, inputs));
  inputs.push_back(options.seeds);
  CATENA_CHECK(check_output(options.output, inputs));
  CATENA_TRY(const std::vector<Vec3> seeds, read_seeds(options.seeds));

  const flow::Flow flow{field.get(), options.kind == "line", options.min_speed};
  flow::TraceOptions trace_options;
  trace_options.length = options.length;
  std::vector<flow::CurvePtr> curves;
  std::map<std::string, int> ends;
  std::size_t knots = 0;
  Progress progress("trace", static_cast<double>(seeds.size()));
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    auto curve = flow::trace(flow, seeds[i], trace_options);
    if (!curve) return Error{fmt::format("{}:{}: {}", options.seeds, i + 2, curve.error().message)};  // the rows follow the header
    knots += (*curve)->knots().size();
    ++ends[flow::end_word((*curve)->first_end())];
    ++ends[flow::end_word((*curve)->last_end())];
    curves.push_back(*curve);
    progress.at(static_cast<double>(i + 1));
  }

  CATENA_TRY(OutputFile out, OutputFile::open(options.output));
  if (vtp) {
    write_vtp(out, curves);
  } else {
    out.write("line,s,x,y,z,tx,ty,tz\n");
    for (std::size_t i = 0; i < curves.size(); ++i) append_csv(out, i, *curves[i]);
  }
  CATENA_CHECK(out.commit());
  fmt::print("{} line{}, {} knots; ends:", curves.size(), curves.size() == 1 ? "" : "s", knots);
  for (const auto& [word, count] : ends) fmt::print(" {} {}", word, count);
  fmt::print("\n");
  return Done{};
}

}  // namespace

void add_trace(CLI::App& program, Work& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("trace", "streamlines through seeds, as arc-length curves");
  command->add_option("SOURCE", options->source, "a scene file (.json) or a data file")->required();
  command->add_option("--field", options->field, "a field of the scene, or a grid of the file")->required();
  command->add_option("--seeds", options->seeds, "seeds, CSV: x,y,z")->required();
  command->add_option("-o,--output", options->output, "lines: .vtp, or CSV: line,s,x,y,z,tx,ty,tz")->required();
  command->add_option("--length", options->length, "longest arc length in each direction, world units (default: 10 L)")
      ->check(CLI::PositiveNumber);
  command->add_option("--kind", options->kind, "vector, or line where v and -v are the same")
      ->check(CLI::IsMember({"vector", "line"}))
      ->capture_default_str();
  command->add_option("--min-speed", options->min_speed, "speeds at or below this end a line")->check(CLI::NonNegativeNumber);
  command->callback([&chosen, options] { chosen = [options] { return trace_lines(*options); }; });
}

}  // namespace catena::app
