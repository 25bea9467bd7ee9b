/// These functions say where things stand in the scene's text (RFC 6901), and what their text is. Pure, any thread.
#pragma once
#include <string>
#include <vector>

#include "engine/base/json.h"
#include "engine/scene/document.h"

namespace catena::app {

using TextEdits = std::vector<scene::Document::Edit>;

/// "/volumes/2" for the item that was read from there (its label is "volumes[2]"); empty where it is no item of a list.
std::string pointer_of(const json::Node& item);

}  // namespace catena::app
