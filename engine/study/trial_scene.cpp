// SPDX-License-Identifier: MIT
#include "engine/study/trial_scene.h"

#include <algorithm>
#include <utility>

#include "engine/base/text.h"
#include "engine/scene/to_json.h"

namespace catena::study {
namespace {

/// Placeholders ("$start") and their values as JSON text.
using Values = std::vector<std::pair<std::string_view, std::string>>;

Values values_of(const Task& task, const Stimulus& s) {
  using scene::to_json;
  return {{"$seed", std::to_string(s.seed)},
          {"$start", to_json(s.start)},
          {"$middle", to_json(s.middle)},
          {"$end", to_json(s.end)},
          {"$path", to_json(s.path)},
          {"$length", to_json(s.length)},
          {"$half_length", to_json(0.5 * s.length)},
          {"$lines", to_json(s.context_points)},
          {"$line_length", to_json(s.context_length)},
          {"$radius", to_json(s.radius)},
          {"$ground", to_json(s.end.z)},
          {"$indicator", to_json(task.world_from_mm(task.indicator_mm))}};
}

bool is_placeholder(const json::Node& node) { return node.kind == json::Kind::string && node.string.starts_with("$"); }

/// Returns true for an object that renders nothing: one of its placeholders stands for an empty list.
bool renders_nothing(const json::Node& item, const Values& values) {
  return std::ranges::any_of(item.members, [&](const auto& member) {
    const auto found = std::ranges::find(values, member.second.string, &Values::value_type::first);
    return is_placeholder(member.second) && found != values.end() && found->second == "[]";
  });
}

std::string with_values(const std::string& text, const json::Node& node, const Values& values);

/// Appends the node's text from the study file from offset `at` on, with its placeholders replaced by values.
void append_with_values(std::string& out, const std::string& text, const json::Node& node, const Values& values, std::size_t& at) {
  if (std::ranges::any_of(node.items, [&](const json::Node& item) { return renders_nothing(item, values); })) {
    std::string rendered;
    for (const json::Node& item : node.items)
      if (!renders_nothing(item, values)) rendered += (rendered.empty() ? "" : ", ") + with_values(text, item, values);
    out.append(text, at, node.begin - at).append("[" + rendered + "]");
    at = node.end;
    return;
  }
  if (is_placeholder(node)) {
    const auto found = std::ranges::find(values, node.string, &Values::value_type::first);
    if (found != values.end()) {
      out.append(text, at, node.begin - at).append(found->second);
      at = node.end;
    }
  }
  for (const json::Node& item : node.items) append_with_values(out, text, item, values, at);
  for (const auto& [key, member] : node.members) append_with_values(out, text, member, values, at);
}

std::string with_values(const std::string& text, const json::Node& node, const Values& values) {
  std::string out;
  std::size_t at = node.begin;
  append_with_values(out, text, node, values, at);
  return out.append(text, at, node.end - at);
}

/// Appends line ends so that the next text is on line `line`.
void append_line_ends(std::string& out, int line) {
  const auto current_line = 1 + std::count(out.begin(), out.end(), '\n');
  if (current_line < line) out.append(static_cast<std::size_t>(line - current_line), '\n');
}

}  // namespace

Outcome check_placeholders(const json::Node& node) {
  if (is_placeholder(node)) {
    std::vector<std::string_view> names;
    static const Values known = values_of({}, {});
    for (const auto& [name, value] : known) names.push_back(name);
    if (std::ranges::count(names, node.string) == 0)
      return json::error_at(node, in_quotes(node.string) + " is not a known placeholder; one of " + join_words(names) + " was expected" +
                                      suggestion(node.string, names));
  }
  for (const json::Node& item : node.items) CATENA_CHECK(check_placeholders(item));
  for (const auto& [key, member] : node.members) CATENA_CHECK(check_placeholders(member));
  return Done{};
}

std::string make_trial_scene(const Study& study, const Trial& trial, const Stimulus& stimulus) {
  const auto task_index = static_cast<std::size_t>(trial.task), condition = static_cast<std::size_t>(trial.condition);
  const Task& task = study.tasks[task_index];
  const json::Node& chain = study.conditions[condition].chains[task_index];
  const Values values = values_of(task, stimulus);
  const std::string links = with_values(study.text, chain, values);
  // the template without its braces; template and chain keep the order and the line numbers of the study file
  std::string parts = with_values(study.text, task.scene_template, values);
  parts = parts.substr(1, parts.size() - 2);
  const char* between = task.scene_template.members.empty() ? "" : ",";
  std::string out = "{";
  if (chain.begin < task.scene_template.begin) {
    append_line_ends(out, chain.line);
    out += "\"chain\": " + links + between;
    append_line_ends(out, task.scene_template.line);
    return out + parts + "}";
  }
  append_line_ends(out, task.scene_template.line);
  out += parts;
  // the text that follows must not become part of a line comment at the end of the template
  if (parts.find("//") != std::string::npos) out += '\n';
  out += between;
  append_line_ends(out, chain.line);
  return out + " \"chain\": " + links + "}";
}

std::string make_field_scene(const Study& study, const Task& task, int seed) {
  Stimulus stimulus;
  stimulus.seed = seed;
  const json::Node& fields = *task.scene_template.find("fields");
  std::string out = "{";
  append_line_ends(out, fields.line);
  return out + "\"fields\": " + with_values(study.text, fields, values_of(task, stimulus)) + "}";
}

}  // namespace catena::study
