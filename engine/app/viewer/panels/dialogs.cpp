// What is told or asked above everything else.
#include <imgui.h>

#include <ctime>
#include <filesystem>
#include <string_view>

#include "engine/app/viewer/panels/panel.h"

namespace catena::app {

namespace {

void centre_next() { ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, {0.5f, 0.5f}); }

std::string file_name_of(const std::string& path) { return std::filesystem::path(path).filename().string(); }

void draw_help(ViewState& state) {
  const ImGuiViewport& view = *ImGui::GetMainViewport();
  centre_next();
  ImGui::SetNextWindowSizeConstraints({0, 0}, view.WorkSize);
  if (ImGui::Begin("Keys and buttons", &state.help, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse)) {
    std::string_view section;
    for (const KeyHelp& key : key_list()) {
      if (section != key.section) {
        if (!section.empty()) ImGui::Spacing();
        section = key.section;
        ImGui::TextColored({0.6f, 0.8f, 1, 1}, "%s", key.section);
      }
      ImGui::TextUnformatted(key.keys);
      ImGui::SameLine(190);
      ImGui::TextUnformatted(key.does);
    }
  }
  ImGui::End();
}

/// Begins the modal of that title while `wanted`; true: draw into it, then EndPopup.
bool begin_question(const char* title, bool wanted) {
  if (wanted && !ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
  centre_next();
  return ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove);
}

bool button(const char* label, ImGuiKey_ key = ImGuiKey_COUNT) {
  const bool pressed = ImGui::Button(label, {110, 0});
  const bool by_key = key != ImGuiKey_COUNT && ImGui::IsKeyPressed(ImGui::GetKeyIndex(key), false);
  return pressed || by_key;
}

void draw_unsaved(PanelContext& context) {
  ViewState& state = context.state;
  if (!begin_question("Before this scene is left", state.ask_unsaved.has_value())) return;
  if (!state.ask_unsaved) {
    ImGui::CloseCurrentPopup();
    return ImGui::EndPopup();
  }
  const bool modified = context.scene.document().is_modified();
  if (modified) ImGui::Text("%s has changes that are not saved.", file_name_of(context.scene.document().path()).c_str());
  if (state.ask_unsaved->quit && context.hand.recording().running())
    ImGui::Text("%s is being recorded: quitting ends it.", file_name_of(context.hand.recording().path()).c_str());
  ImGui::Spacing();
  const auto answer = [&](Answer given) {
    state.answer = given;
    ImGui::CloseCurrentPopup();
  };
  if (modified) {
    if (button("Save", ImGuiKey_Enter)) answer(Answer::save);
    ImGui::SetItemDefaultFocus();
    ImGui::SameLine();
    if (button("Discard")) answer(Answer::discard);
  } else {
    if (button("Quit", ImGuiKey_Enter)) answer(Answer::discard);
    ImGui::SetItemDefaultFocus();
  }
  ImGui::SameLine();
  if (button("Cancel", ImGuiKey_Escape)) answer(Answer::cancel);
  ImGui::EndPopup();
}

std::string words_of_time(std::int64_t at_s) {
  const auto time = static_cast<std::time_t>(at_s);
  std::tm parts{};
  char words[64] = "";
  if (::localtime_r(&time, &parts) != nullptr) std::strftime(words, sizeof words, "%d %B, %H:%M", &parts);
  return words;
}

void draw_left(PanelContext& context, bool wanted) {
  ViewState& state = context.state;
  if (!begin_question("Unsaved changes of an earlier run", wanted)) return;
  if (!state.ask_left) {
    ImGui::CloseCurrentPopup();
    return ImGui::EndPopup();
  }
  ImGui::Text("%s had changes that were not saved when its window ended", file_name_of(context.scene.document().path()).c_str());
  ImGui::Text("(%s).", words_of_time(state.ask_left->at_s).c_str());
  ImGui::Spacing();
  const auto answer = [&](AnswerToLeft given) {
    state.answer_to_left = given;
    ImGui::CloseCurrentPopup();
  };
  if (button("Restore", ImGuiKey_Enter)) answer(AnswerToLeft::restore);
  ImGui::SetItemDefaultFocus();
  ImGui::SameLine();
  if (button("Discard")) answer(AnswerToLeft::discard);
  ImGui::SameLine();
  if (button("Later", ImGuiKey_Escape)) answer(AnswerToLeft::later);
  ImGui::EndPopup();
}

void draw_dropped(PanelContext& context, bool wanted) {
  ViewState& state = context.state;
  if (!begin_question("A file was dropped", wanted)) return;
  if (!state.ask_dropped) {
    ImGui::CloseCurrentPopup();
    return ImGui::EndPopup();
  }
  ImGui::TextUnformatted(file_name_of(*state.ask_dropped).c_str());
  ImGui::Spacing();
  const auto done = [&] {
    state.ask_dropped.reset();
    ImGui::CloseCurrentPopup();
  };
  if (button("Add to the scene", ImGuiKey_Enter)) {
    state.add = state.ask_dropped;
    done();
  }
  ImGui::SetItemDefaultFocus();
  ImGui::SameLine();
  if (state.ask_dropped && button("Open instead")) {
    state.open = state.ask_dropped;
    done();
  }
  ImGui::SameLine();
  if (state.ask_dropped && button("Cancel", ImGuiKey_Escape)) done();
  ImGui::EndPopup();
}

}  // namespace

void draw_dialogs(PanelContext& context) {
  if (context.state.help) draw_help(context.state);
  // one question at a time
  const ViewState& state = context.state;
  draw_unsaved(context);
  draw_dropped(context, state.ask_dropped && !state.ask_unsaved);
  draw_left(context, state.ask_left && !state.ask_unsaved && !state.ask_dropped);
}

}  // namespace catena::app
