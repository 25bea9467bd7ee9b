#include "engine/app/log_scene.h"

#include <filesystem>

#include "engine/app/run_files.h"
#include "engine/base/text.h"
#include "haptics/extract/extract.h"
#include "haptics/servo/log/reader.h"

namespace catena::app {

namespace log = haptics::log;
namespace fs = std::filesystem;

Result<log::LogHeader> log_header(const std::string& scene_path, const std::vector<std::string>& field_options, const std::string& device,
                                  double rate_hz) {
  log::LogHeader header;
  header.scene_path = scene_path;
  if (is_scene_file(scene_path)) {
    CATENA_TRY(header.scene_text, read_text(scene_path, "a scene file (JSON)", kMaxJsonBytes));
  }
  header.fields = field_options;
  header.device = device;
  header.catena_version = kCatenaVersion;
  header.rate_hz = rate_hz;
  return header;
}

Result<LinkColumns> columns_of_log(const std::string& path) {
  CATENA_TRY(log::LogReader reader, log::LogReader::open(path));
  LinkColumns columns;
  for (log::LogEvent event = reader.next(); event != log::LogEvent::done; event = reader.next())
    if (event == log::LogEvent::program) columns.add(reader.program().link_names());
  return columns;
}

namespace {

std::string from_folder(const std::string& folder, const std::string& path) {
  return fs::path(path).is_absolute() ? path : (fs::path(folder) / path).string();
}

// NAME=FILE[:GRID], FILE as seen from where the recording was made
std::string field_from_folder(const std::string& folder, const std::string& option) {
  const auto equals = option.find('=');
  return equals == std::string::npos ? option : option.substr(0, equals + 1) + from_folder(folder, option.substr(equals + 1));
}

}  // namespace

LogScene::LogScene(log::LogHeader header, std::string scene_path, std::vector<std::string> field_options)
    : header_(std::move(header)), from_file_(!scene_path.empty()), field_options_(std::move(field_options)) {
  scene_path_ = from_file_ ? std::move(scene_path) : from_folder(header_.working_folder, header_.scene_path);
  for (const std::string& option : header_.fields) {
    const std::string name = option.substr(0, option.find('='));
    bool replaced = false;
    for (const std::string& other : field_options_) replaced = replaced || other.starts_with(name + "=");
    if (!replaced) field_options_.push_back(field_from_folder(header_.working_folder, option));
  }
}

Outcome LogScene::read(const std::optional<std::string>& own_text) {
  if (scene_ && own_text_ == own_text) return Done{};
  own_text_ = own_text;
  if (!own_text && (from_file_ || !is_scene_file(scene_path_))) {
    CATENA_TRY(scene_, open_scene(scene_path_, field_options_));
    return Done{};
  }
  CATENA_TRY(const std::vector<scene::FieldOverride> overrides, field_overrides(field_options_));
  CATENA_TRY(scene_, scene::parse_scene(own_text ? *own_text : header_.scene_text, scene_path_, overrides));
  return Done{};
}

Result<std::shared_ptr<const haptics::Program>> LogScene::build(const log::LogProgram& program) {
  CATENA_CHECK(read(program.scene_text));
  scene::Coupling& coupling = scene_->coupling;
  // a scene from outside keeps what it states; what it leaves open was fitted when it was recorded
  if (!from_file_) {
    coupling.stiffness_n_per_m = program.coupling.stiffness_n_per_m;
    coupling.damping_ns_per_m = program.coupling.damping_ns_per_m;
    coupling.max_force_n = program.coupling.max_force_n;
    coupling.method = static_cast<scene::CouplingMethod>(program.coupling.method);
  }
  if (!from_file_ || !coupling.ramp_s) coupling.ramp_s = program.coupling.ramp_s;
  if (!from_file_ || !scene_->workspace.given)
    scene_->workspace = {program.metres_per_unit, program.workspace_origin, program.workspace_rotation, scene_->workspace.given};
  // links that follow a widget were made where it was then
  for (const log::LogProgram::Widget& from : program.widgets) {
    const scene::Entity found = scene::find_widget(*scene_, from.name);
    if (!found) continue;
    CATENA_CHECK(scene::use_widget(*scene_, found));
    scene::Widget& widget = scene_->world.get<scene::Widget>(found);
    widget.spec.revision = widget.state.revision = from.revision;
    widget.state.pose = from.pose;
    widget.state.value = from.value;
  }
  return haptics::extract_program(*scene_, program.limits);
}

Result<std::vector<std::string>> LogScene::inputs() {
  CATENA_CHECK(read({}));
  return inputs_of(*scene_);
}

}  // namespace catena::app
