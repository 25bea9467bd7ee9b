/// catena import IN -o OUT: any file that Catena reads, as one of those that it writes (engine/field/write.h).
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "engine/app/command.h"
#include "engine/app/run_files.h"
#include "engine/base/tell.h"
#include "engine/base/text.h"
#include "engine/field/formats.h"
#include "engine/field/load.h"
#include "engine/field/write.h"

namespace catena::app {

namespace {

struct ImportOptions {
  std::string input, output, grid, name;
  std::vector<int> shape;
  std::vector<double> spacing{1, 1, 1}, origin{0, 0, 0};
  std::string type = "float32";
};

Outcome import_file(const ImportOptions& o) {
  RunFiles files;
  files.reads(o.input);
  files.writes("-o", o.output);
  CATENA_CHECK(files.check());
  if (!field::is_written(o.output) && !o.output.starts_with("/dev/"))
    return Error{o.output + ": expected an output that ends in " + field::written_endings()};
  const bool raw_file = field::needs_layout(o.input);
  if (!raw_file && !o.shape.empty()) return Error{o.input + ": --shape belongs to .raw files"};
  field::LoadRequest request;
  request.path = o.input;
  request.grid = o.grid;
  if (raw_file) {
    if (o.shape.empty()) return Error{o.input + ": a .raw file needs --shape NX NY NZ"};
    field::RawLayout raw;
    raw.shape = {o.shape[0], o.shape[1], o.shape[2]};
    raw.spacing = Vec3(o.spacing[0], o.spacing[1], o.spacing[2]);
    raw.origin = Vec3(o.origin[0], o.origin[1], o.origin[2]);
    raw.type = o.type;
    request.raw = raw;
  }
  std::vector<std::string> notes;
  CATENA_TRY(const std::string name, field::convert(request, o.output, o.name, &notes));
  for (const std::string& note : notes) tell_from_catena("note: " + o.input + ": " + note);
  fmt::print("{}: {}\n", printable(o.output), printable(name));
  return Done{};
}

}  // namespace

void add_import(CLI::App& program, Work& chosen) {
  auto options = std::make_shared<ImportOptions>();
  CLI::App* command = program.add_subcommand("import", "convert a data file");
  command->add_option("IN", options->input, field::field_file_words())->required();
  command->add_option("-o,--output", options->output, "the grid: " + field::written_endings())->required();
  command->add_option("--grid", options->grid, "which grid of a .vdb");
  command->add_option("--name", options->name, "the grid's name in the output");
  command->add_option("--shape", options->shape, ".raw: voxels along x y z")->expected(3);
  command->add_option("--spacing", options->spacing, ".raw: voxel edges")->expected(3)->capture_default_str();
  command->add_option("--origin", options->origin, ".raw: world position of the first voxel's centre")->expected(3)->capture_default_str();
  command->add_option("--type", options->type, ".raw: float32, uint8, int16, ... or float32x3")->capture_default_str();
  command->callback([&chosen, options] { chosen = [options] { return import_file(*options); }; });
}

}  // namespace catena::app
