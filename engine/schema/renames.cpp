// SPDX-License-Identifier: MIT
#include "engine/schema/renames.h"

#include <algorithm>
#include <vector>

#include "engine/base/json_edit.h"
#include "engine/base/text.h"

namespace catena::schema {
namespace {

/// Kind of change to a file by a row of the table. distributed: the members become keys of other objects (distribute_plan). nested: a word
/// with keys beside it becomes an object (nest_color_by); other values of the key are unchanged.
enum class Change { renamed, distributed, nested };

/// A key of version 0.2 and its name in 0.3. `path`: the keys from the root with the old name last; "*" stands for any key or index.
/// `values`: old and new words, where the value is one of several words; an empty `key` keeps the key.
struct Rename {
  std::string_view path, key;
  std::vector<std::pair<std::string_view, std::string_view>> values = {};
  Change change = Change::renamed;
};

const std::vector<Rename>& scene_renames() {
  static const std::vector<Rename> table{
      {"/chain/*/on", "active_when"},
      {"/chain/*/indicate", "release_cue"},
      {"/chain/*/indicate/cue", "type"},
      {"/chain/*/indicate/at", "distance"},
      {"/chain/*/indicate/from", "onset"},
      {"/chain/*/towards", "direction", {{"high", "up_gradient"}, {"low", "down_gradient"}}},
      {"/chain/*/law", "", {{"safe", "robust"}, {"printed", "as_published"}}},
      {"/chain/*/search", "search_radius"},
      {"/chain/*/least_length", "min_length"},
      {"/chain/*/least_swirl", "min_swirl"},
      {"/chain/*/*/of", "quantity"},
      {"/modes/*/on", "active_when"},
      {"/curves/*/vortex_cores/least_length", "min_length"},
      {"/curves/*/vortex_cores/least_swirl", "min_swirl"},
      {"/meshes/*/drawn", "visible"},
      {"/fields/*/crop/lo", "min"},
      {"/fields/*/crop/hi", "max"},
      {"/clip/*/box/lo", "min"},
      {"/clip/*/box/hi", "max"},
      {"/glyphs/*/on/box/lo", "min"},
      {"/glyphs/*/on/box/hi", "max"},
      {"/glyphs/*/full_speed", "reference_speed"},
      {"/glyphs/*/at", "anchor"},
      {"/widgets/*/lo", "min"},
      {"/widgets/*/hi", "max"},
      {"/widgets/*/turning", "rotation"},
      {"/widgets/*/touch", "rotate_on_contact"},
      {"/widgets/*/near", "grab_distance"},
      {"/fog/start", "near"},
      {"/fog/end", "far"},
      {"/fog/most", "max_opacity"},
      {"/ground/at", "height"},
      {"/indicator/ahead", "anchor", {{"true", "tail"}, {"false", "center"}}},
      {"/labels/*/hidden_behind", "occluded"},
      {"/cursor/ghost", "show_occluded"},
      {"/slices/*/lit", "shade"},
      {"/streamlines/*/pulse", "animated_bands"},
      {"/streamlines/*/seeds/evenly_spaced/test", "termination_ratio"},
      {"/stereo/swap", "swap_eyes"},
      {"/plan", "quality\" and \"coupling", {}, Change::distributed},
      {"/streamlines/*/color_by", "color_by.field\" or \"color_by.quantity", {}, Change::nested},
      {"/meshes/*/color_by", "color_by.field", {}, Change::nested},
  };
  return table;
}

const std::vector<Rename>& study_renames() {
  static const std::vector<Rename> table{
      {"/tasks/*/stimulus/lines", "context_streamlines"},
      {"/tasks/*/stimulus/line_mm", "context_length_mm"},
      {"/tasks/*/stimulus/bend_mm", "min_curvature_radius_mm"},
      {"/tasks/*/limits/told_s", "announced_limit_s"},
      {"/tasks/*/limits/ends_s", "timeout_s"},
      {"/tasks/*/start_mm", "start_radius_mm"},
      {"/tasks/*/reach_mm", "target_radius_mm"},
      {"/operator/tremor_lo_hz", "tremor_min_hz"},
      {"/operator/tremor_hi_hz", "tremor_max_hz"},
      {"/findings/*/paper", "claim"},
      {"/findings/*/expect", "alternative"},
      {"/findings/*/why", "reason"},
      {"/findings/*/test", "", {{"weaker", "weaker_correlation"}, {"none", "untestable"}}},
  };
  return table;
}

/// Old and new names of command line options.
constexpr std::pair<std::string_view, std::string_view> kOptions[] = {
    {"--until-stdin-ends", "--exit-with-stdin"},
    {"--framed-by", "--frame-ancestor"},
    {"--full-screen", "--fullscreen"},
    {"--window-screenshot", "--screenshot-ui"},
    {"--phase", "--animation-phase"},
    {"--plan", "--quality, --max-proxy-error or --max-tick-us"},
    {"--thorough", "--effort thorough"},
    {"--quick", "--effort quick"},
};

/// Returns whether a path of keys has the form of a pattern, "*" being any step.
bool is_match(std::string_view pattern, std::string_view path) {
  while (!pattern.empty() && !path.empty()) {
    const std::size_t p = pattern.find('/', 1), q = path.find('/', 1);
    const std::string_view expected = pattern.substr(0, p), step = path.substr(0, q);
    if (expected != "/*" && expected != step) return false;
    pattern.remove_prefix(expected.size()), path.remove_prefix(step.size());
  }
  return pattern.empty() && path.empty();
}

/// Returns the value as a word, as listed in `values`; empty for values that are neither a string nor a boolean.
std::string_view word_of(const json::Node& value) {
  if (value.kind == json::Kind::boolean) return value.boolean ? "true" : "false";
  return value.kind == json::Kind::string ? std::string_view(value.string) : std::string_view();
}

/// Old name in a file.
struct Match {
  const json::Node* object;                                    ///< object that has the key
  std::size_t member;                                          ///< index of the key in the object
  const Rename* rename;                                        ///< row of the table
  const std::pair<std::string_view, std::string_view>* value;  ///< old and new word of the value; null: the value is kept
};

/// Finds the old names in the order of the text.
class Finder {
 public:
  void visit(const json::Node& node, const std::string& path, FileKind kind) {
    for (std::size_t i = 0; i < node.items.size(); ++i)
      if (has_children(node.items[i])) descend(node.items[i], path + "/" + std::to_string(i), kind);
    for (std::size_t i = 0; i < node.members.size(); ++i) {
      const auto& [key, value] = node.members[i];
      const std::string at = path + "/" + json::escape_pointer_token(key);
      add(node, i, at, kind);
      if (has_children(value)) descend(value, at, kind);
    }
  }
  std::vector<Match> found;

 private:
  static bool has_children(const json::Node& node) { return !node.items.empty() || !node.members.empty(); }
  /// Continues with the scene's table in the parts of a study that are scenes and chains.
  void descend(const json::Node& node, const std::string& path, FileKind kind) {
    if (kind == FileKind::study && is_match("/tasks/*/scene", path)) return visit(node, "", FileKind::scene);
    if (kind == FileKind::study && (is_match("/conditions/*/chain", path) || is_match("/conditions/*/chain/*", path)) &&
        node.kind == json::Kind::array)
      return visit(node, "/chain", FileKind::scene);
    visit(node, path, kind);
  }
  void add(const json::Node& object, std::size_t member, const std::string& path, FileKind kind) {
    const json::Node& value = object.members[member].second;
    for (const Rename& rename : kind == FileKind::scene ? scene_renames() : study_renames()) {
      if (!is_match(rename.path, path) || (rename.change == Change::nested && value.kind != json::Kind::string)) continue;
      const auto word = std::ranges::find(rename.values, word_of(value), &std::pair<std::string_view, std::string_view>::first);
      const bool is_word = word != rename.values.end();
      if (!rename.key.empty() || is_word) found.push_back({&object, member, &rename, is_word ? &*word : nullptr});
    }
  }
};

std::vector<Match> find_old_names(const json::Node& root, FileKind kind) {
  Finder finder;
  finder.visit(root, "", kind);
  return std::move(finder.found);
}

/// Replaces "plan" of a scene by "quality", unless the scene has "quality", which takes precedence, and by keys of "coupling".
Outcome distribute_plan(std::string& text, const std::string& file) {
  CATENA_TRY(const json::Node scene, json::parse(text, file));
  const json::Node* plan = scene.find("plan");
  if (plan == nullptr) return Done{};
  CATENA_CHECK(json::expect_object(*plan, "plan"));
  const auto set = [&](const char* from, const char* to, const char* prefix) -> Outcome {
    const json::Node* value = plan->find(from);
    if (value == nullptr || value->kind != json::Kind::number) return Done{};
    const std::string number = json::serialize_number(value->number);
    CATENA_TRY(text, json::set_value(text, file, to, prefix != nullptr ? json::serialize_string(prefix + number) : number));
    return Done{};
  };
  if (scene.find("quality") == nullptr) {
    CATENA_CHECK(set("error", "/quality", "error="));
    CATENA_CHECK(set("time", "/quality", "time="));
  }
  CATENA_CHECK(set("hand_error", "/coupling/max_proxy_error", nullptr));
  CATENA_CHECK(set("hand_time", "/coupling/max_tick_us", nullptr));
  CATENA_TRY(text, json::remove_value(text, file, "/plan"));
  return Done{};
}

/// Moves the keys of a color scale into "color_by" of an item that has it as a word.
Result<std::string> nest_color_by(std::string text, const std::string& file, bool is_quantity) {
  CATENA_TRY(const json::Node item, json::parse(text, file));
  std::string object = std::string(is_quantity ? "{\"quantity\": " : "{\"field\": ") + json::serialize_node(*item.find("color_by"));
  std::vector<std::string> moved;
  for (const char* key : {"color", "range", "mapping", "linear_below", "transfer"}) {
    const json::Node* value = item.find(key);
    if (value == nullptr) continue;
    object += ", " + json::serialize_string(key) + ": " + json::serialize_node(*value);
    moved.push_back(std::string("/") + key);
  }
  CATENA_TRY(text, json::set_value(text, file, "/color_by", object + "}"));
  for (const std::string& key : moved) {
    CATENA_TRY(text, json::remove_value(text, file, key));
  }
  return text;
}

Outcome nest_color_words(std::string& text, const std::string& file) {
  CATENA_TRY(const json::Node scene, json::parse(text, file));
  const json::Node* fields = scene.find("fields");
  std::vector<json::Replacement> edits;
  for (const char* list : {"streamlines", "meshes"}) {
    const json::Node* items = scene.find(list);
    if (items == nullptr) continue;
    for (const json::Node& item : items->items) {
      const json::Node* word = item.find("color_by");
      if (word == nullptr || word->kind != json::Kind::string) continue;
      const bool is_field = fields != nullptr && fields->find(word->string) != nullptr;
      const bool is_quantity =
          list == std::string_view("streamlines") && !is_field && (word->string == "speed" || word->string == "arc_length");
      CATENA_TRY(std::string nested, nest_color_by(text.substr(item.begin, item.end - item.begin), file, is_quantity));
      edits.push_back({item.begin, item.end, std::move(nested)});
    }
  }
  CATENA_TRY(text, json::replace_ranges(text, file, std::move(edits)));
  return Done{};
}

/// Changes the structure of a scene of 0.2 to that of 0.3 where they differ.
Result<std::string> restructure(std::string scene, const std::string& file) {
  CATENA_CHECK(distribute_plan(scene, file));
  CATENA_CHECK(nest_color_words(scene, file));
  return scene;
}

}  // namespace

Outcome check_names(const json::Node& root, FileKind kind) {
  const std::vector<Match> found = find_old_names(root, kind);
  if (found.empty()) return Done{};
  const auto& [key, value] = found.front().object->members[found.front().member];
  const Rename& rename = *found.front().rename;
  const std::string old_name = in_quotes(rename.key.empty() ? found.front().value->first : std::string_view(key));
  const std::string new_name = in_quotes(rename.key.empty() ? found.front().value->second : rename.key);
  const bool in_file = value.line > 0 && value.file != nullptr && !value.file->empty();
  return json::error_at(value, old_name + " is now " + new_name + "; the new name was expected: `catena upgrade " +
                                   (in_file ? *value.file : std::string("FILE")) + "` replaces the old names");
}

Result<UpgradedText> upgrade_names(std::string_view text, const std::string& file, FileKind kind) {
  CATENA_TRY(const json::Node root, json::parse(text, file));
  std::vector<json::Replacement> edits;
  const std::vector<Match> found = find_old_names(root, kind);
  for (const Match& match : found) {
    const json::Node& value = match.object->members[match.member].second;
    const std::string_view key = match.rename->key;
    if (match.rename->change != Change::renamed) continue;
    if (!key.empty() && match.object->find(key) != nullptr)
      return json::error_at(value, in_quotes(match.object->members[match.member].first) + " is now " + in_quotes(key) +
                                       ", which is also present; one of them was expected");
    if (!key.empty()) edits.push_back(json::rename_key(text, *match.object, match.member, key));
    if (match.value != nullptr) edits.push_back({value.begin, value.end, json::serialize_string(match.value->second)});
  }
  CATENA_TRY(std::string upgraded, json::replace_ranges(text, file, std::move(edits)));
  if (found.empty()) return UpgradedText{std::move(upgraded), 0};
  if (kind == FileKind::scene) {
    CATENA_TRY(upgraded, restructure(upgraded, file));
    return UpgradedText{std::move(upgraded), static_cast<int>(found.size())};
  }
  CATENA_TRY(const json::Node study, json::parse(upgraded, file));
  edits.clear();
  if (const json::Node* tasks = study.find("tasks"))
    for (const json::Node& task : tasks->items) {
      const json::Node* scene = task.find("scene");
      if (scene == nullptr || scene->kind != json::Kind::object) continue;
      CATENA_TRY(std::string changed, restructure(upgraded.substr(scene->begin, scene->end - scene->begin), file));
      edits.push_back({scene->begin, scene->end, std::move(changed)});
    }
  CATENA_TRY(upgraded, json::replace_ranges(upgraded, file, std::move(edits)));
  return UpgradedText{std::move(upgraded), static_cast<int>(found.size())};
}

std::string_view renamed_option(std::string_view option) {
  const auto* found = std::ranges::find(kOptions, option, &std::pair<std::string_view, std::string_view>::first);
  return found != std::end(kOptions) ? found->second : std::string_view();
}

}  // namespace catena::schema
