// SPDX-License-Identifier: MIT
#include "haptics/build/build_program.h"

#include <algorithm>

#include "engine/base/text.h"
#include "engine/scene/widgets.h"
#include "haptics/constraints/widget_link.h"

namespace catena::haptics {
namespace {

json::Node number_node(const json::Node& like, double value) {
  json::Node node;
  node.kind = json::Kind::number;
  node.line = like.line;
  node.file = like.file;
  node.label = like.label;
  node.number = value;
  return node;
}

json::Node vector_node(const json::Node& like, const Vec3& value) {
  json::Node node = number_node(like, 0);
  node.kind = json::Kind::array;
  for (int a = 0; a < 3; ++a) node.items.push_back(number_node(like, value[a]));
  return node;
}

Result<scene::Entity> widget_named(scene::Scene& scene, const json::Node& value, widget::Kind kind, std::string_view expected) {
  CATENA_CHECK(json::check_known_keys(value, {"widget"}));
  CATENA_TRY(const std::string name, json::require_string(value, "widget"));
  const json::Node& where = *value.find("widget");
  const scene::Entity found = scene::find_widget(scene, name);
  if (!found) return json::error_at(where, "unknown widget " + in_quotes(name) + "; one of the scene's \"widgets\" was expected");
  const widget::Kind is = scene.entities.get<scene::Widget>(found).spec.kind;
  if (is != kind)
    return json::error_at(where, "widget " + in_quotes(name) + " is of type " + in_quotes(scene::to_string(is)) + "; " +
                                     std::string(expected) + " was expected");
  return found;
}

Outcome find_along(const scene::Widget& from, const std::function<const std::vector<int>*(const std::string&)>& links_of,
                   widget::Spec& spec) {
  spec.along_links.clear();
  const json::Node* nodes = from.where.find("along");
  for (std::size_t k = 0; k < from.along_links.size(); ++k) {
    const std::vector<int>* links = links_of(from.along_links[k]);
    if (links == nullptr)
      return json::error_at(nodes != nullptr && k < nodes->items.size() ? nodes->items[k] : from.where,
                            in_quotes(from.along_links[k]) + " is not a link of the chain; the name of a link was expected");
    spec.along_links.insert(spec.along_links.end(), links->begin(), links->end());
  }
  return Done{};
}

}  // namespace

Result<json::Node> resolve_widget_values(scene::Scene& scene, const json::Node& item) {
  json::Node out = item;
  for (auto& [key, value] : out.members) {
    if (value.kind != json::Kind::object || value.find("widget") == nullptr) continue;
    if (key == "seed") {
      CATENA_TRY(const scene::Entity e, widget_named(scene, value, widget::Kind::seed, "a seed"));
      value = vector_node(value, scene.entities.get<scene::Widget>(e).report.pose.points[0]);
    } else if (key == "level") {
      CATENA_TRY(const scene::Entity e, widget_named(scene, value, widget::Kind::isolevel, "an isolevel"));
      CATENA_CHECK(scene::resolve_widget(scene, e));
      value = number_node(value, scene.entities.get<scene::Widget>(e).report.value);
    }
  }
  return out;
}

Outcome add_widgets(scene::Scene& scene, const std::function<const std::vector<int>*(const std::string&)>& links_of,
                    HapticProgram& program) {
  std::vector<scene::Entity> entities;
  scene.entities.each<scene::Widget>([&](scene::Entity e, const scene::Widget&) { entities.push_back(e); });
  if (entities.empty()) return Done{};
  const json::Node& first = scene.entities.get<scene::Widget>(entities.front()).where;
  if (program.coupling.method != CouplingMethod::chain)
    return json::error_at(first, "widgets need a proxy chain; \"method\": \"chain\" was expected in \"coupling\"");
  if (entities.size() > static_cast<std::size_t>(kMaxWidgets))
    return json::error_at(first, "the scene has too many widgets; at most " + std::to_string(kMaxWidgets) + " were expected");
  for (const scene::Entity e : entities) {
    CATENA_TRY(widget::Spec spec, scene::resolve_widget(scene, e));
    const scene::Widget& from = scene.entities.get<scene::Widget>(e);
    spec.pose = from.report.pose;
    spec.value = from.report.value;
    CATENA_CHECK(find_along(from, links_of, spec));
    program.widgets.push_back(std::move(spec));
    program.widget_names.push_back(scene.entities.get<scene::Name>(e).value);
  }
  for (const Link& link : program.links)
    for (const char* name : widget::kSharedLinkNames)
      if (link.name == name)
        return json::error_at(first,
                              "the chain has a link named \"" + link.name + "\", which is reserved for widgets; another name was expected");
  add_widget_links(program);
  return Done{};
}

}  // namespace catena::haptics
