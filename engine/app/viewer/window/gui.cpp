// SPDX-License-Identifier: MIT
#include "engine/app/viewer/window/gui.h"

// ImGui's backend includes GLFW, which must not declare OpenGL
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "render/text/font.h"

namespace catena::app {

namespace {

constexpr int kFocusSettleFrames = 3;  // frames until a newly opened item has keyboard focus

void choose_style(float scale) {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 4;
  style.FrameRounding = 3;
  style.GrabRounding = 3;
  style.WindowBorderSize = 0;
  // the side window is slightly transparent; menus and dialogs are opaque
  style.Colors[ImGuiCol_WindowBg].w = 0.88f;
  style.Colors[ImGuiCol_PopupBg].w = style.Colors[ImGuiCol_MenuBarBg].w = 1;
  style.ScaleAllSizes(scale);
}

/// Starts a frame of ImGui. A text field without focus starts anew when it gains it: ImGui 1.86 would retain the undo history, and undoing
/// writes outside the text if the program has replaced it by a shorter one.
void start_frame() {
  ImGui::NewFrame();
  ImGuiContext& context = *ImGui::GetCurrentContext();
  if (context.ActiveId != context.InputTextState.ID) context.InputTextState.ID = 0;
}

}  // namespace

struct Gui::Impl {
  Window* window;
  std::shared_ptr<const render::UiTexture> font;
  KeyFrameScheduler keys{};
  Input last{};                     ///< the input segment sent most recently
  bool moved = false;               ///< whether the pointer has moved since the last frame
  int settling = 0;                 ///< hidden frames to run before the next key press
  float wheel = 0;                  ///< wheel motion in hidden frames
  std::optional<ImVec2> pointed{};  ///< position of a substitute pointer, for one frame
  bool pressed = false;             ///< whether the button of the substitute pointer is down

  /// Runs a hidden frame with the pointer at a position and the buttons of an input segment.
  void make(const Input& buttons, double x, double y, const Frame& frame);
  void tell_key(const KeyEvent& event) const;
  void framed() {
    keys.end_frame();
    moved = false;
    settling = std::max(0, settling - 1);
  }
};

Gui::Gui(Window& window, const std::vector<float>& text_pixels) : impl_(std::make_unique<Impl>(Impl{.window = &window, .font = nullptr})) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.KeyRepeatDelay = std::numeric_limits<float>::max();  // the system generates key repeats (keys.h)
  const float scale = window.content_scale();
  choose_style(scale);
  ImGui_ImplGlfw_InitForVulkan(window.glfw_window(), false);
  window.forward_events_to_gui(true);

  // non-ASCII characters that units and names use
  static const ImWchar kRanges[] = {0x20, 0x17f, 0x370, 0x3ff, 0x2010, 0x2027, 0x2070, 0x209f, 0x2190, 0x2193, 0x2200, 0x22ff, 0};
  const auto font = render::find_font("DejaVu Sans", false);
  std::vector<float> heights{kTextPixels};
  heights.insert(heights.end(), text_pixels.begin(), text_pixels.end());
  for (const float height : heights) {
    const float pixels = std::max(8.0f, height * scale);
    if (!font || io.Fonts->AddFontFromFileTTF(font->path.c_str(), pixels, nullptr, kRanges) == nullptr) io.Fonts->AddFontDefault();
  }
  unsigned char* rgba = nullptr;
  int width = 0, height = 0;
  io.Fonts->GetTexDataAsRGBA32(&rgba, &width, &height);
  auto texture = std::make_shared<render::UiTexture>();
  texture->width = static_cast<std::uint32_t>(width);
  texture->height = static_cast<std::uint32_t>(height);
  texture->rgba.assign(rgba, rgba + std::size_t(4) * std::size_t(width) * std::size_t(height));
  io.Fonts->SetTexID(texture.get());
  io.Fonts->ClearTexData();
  impl_->font = std::move(texture);
}

Gui::~Gui() {
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Gui::Impl::make(const Input& buttons, double x, double y, const Frame& frame) {
  ImGui_ImplGlfw_NewFrame();
  ImGuiIO& io = ImGui::GetIO();
  io.DeltaTime = std::max(io.DeltaTime, 1e-6f);
  io.MousePos = {static_cast<float>(x), static_cast<float>(y)};
  io.MouseDown[0] = buttons.left;
  io.MouseDown[1] = buttons.right;
  io.MouseDown[2] = buttons.middle;
  wheel += std::exchange(io.MouseWheel, 0.0f);
  start_frame();
  framed();
  frame.draw_panels();
  ImGui::EndFrame();
  frame.run_commands();
}

void Gui::Impl::tell_key(const KeyEvent& event) const {
  using What = KeyEvent::Type;
  GLFWwindow* const native = window->glfw_window();
  if (event.type == What::press || event.type == What::release)
    ImGui_ImplGlfw_KeyCallback(native, event.key, event.scancode, event.type == What::press ? GLFW_PRESS : GLFW_RELEASE, 0);
  if (event.type == What::character) ImGui_ImplGlfw_CharCallback(native, event.character);
  if (event.type == What::focus_gained || event.type == What::focus_lost)
    ImGui_ImplGlfw_WindowFocusCallback(native, event.type == What::focus_gained ? GLFW_TRUE : GLFW_FALSE);
}

void Gui::feed_input(const Input& piece, const Frame& frame) {
  Impl& parts = *impl_;
  const Input& last = parts.last;
  if (piece.left != last.left || piece.right != last.right || piece.middle != last.middle) {
    // a hidden frame for the end of a drag before its button is released, and for keys typed earlier
    if (parts.moved || parts.keys.has_pending()) parts.make(last, piece.x, piece.y, frame);
    parts.make(piece, piece.x, piece.y, frame);
  }
  for (const KeyEvent& event : piece.key_event ? resolve_repeats(*piece.key_event) : std::vector<KeyEvent>()) {
    const bool stroke = event.type == KeyEvent::Type::press || event.type == KeyEvent::Type::character;
    while (stroke && parts.settling > 0) parts.make(piece, piece.x, piece.y, frame);
    if (!parts.keys.fits_current_frame(event)) parts.make(piece, piece.x, piece.y, frame);
    parts.keys.add(event);
    parts.tell_key(event);
  }
  parts.last = piece;
  parts.moved = parts.moved || piece.dx != 0 || piece.dy != 0;
}

void Gui::expect_focus_change() { impl_->settling = kFocusSettleFrames; }

void Gui::begin() {
  ImGui_ImplGlfw_NewFrame();
  ImGuiIO& io = ImGui::GetIO();
  io.MouseWheel += std::exchange(impl_->wheel, 0.0f);
  if (const auto pointed = std::exchange(impl_->pointed, std::nullopt)) {
    io.MousePos = *pointed;
    io.MouseDown[0] = impl_->pressed;
  }
  start_frame();
  impl_->framed();
}

void Gui::set_virtual_pointer(double x, double y, bool pressed) {
  impl_->pointed = ImVec2(static_cast<float>(x), static_cast<float>(y));
  impl_->pressed = pressed;
}

render::UiItems Gui::end() {
  ImGui::Render();
  const ImDrawData* data = ImGui::GetDrawData();
  render::UiItems items;
  const ImVec2 scale = data->FramebufferScale;
  for (int n = 0; n < data->CmdListsCount; ++n) {
    const ImDrawList* list = data->CmdLists[n];
    const auto base_vertex = static_cast<std::uint32_t>(items.vertices.size());
    const auto base_index = static_cast<std::uint32_t>(items.indices.size());
    for (const ImDrawVert& v : list->VtxBuffer) items.vertices.push_back({v.pos.x * scale.x, v.pos.y * scale.y, v.uv.x, v.uv.y, v.col});
    items.indices.insert(items.indices.end(), list->IdxBuffer.begin(), list->IdxBuffer.end());
    for (const ImDrawCmd& command : list->CmdBuffer) {
      if (command.UserCallback != nullptr || command.ElemCount == 0) continue;
      items.draws.push_back(
          {impl_->font,
           {command.ClipRect.x * scale.x, command.ClipRect.y * scale.y, command.ClipRect.z * scale.x, command.ClipRect.w * scale.y},
           base_index + command.IdxOffset,
           command.ElemCount,
           base_vertex + command.VtxOffset});
    }
  }
  return items;
}

bool Gui::covers(double x, double y) const {
  const ImVec2 at(static_cast<float>(x), static_cast<float>(y));
  if (ImGui::GetTopMostPopupModal() != nullptr) return true;
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
    if (window->WasActive && !window->Hidden && (window->Flags & ImGuiWindowFlags_NoMouseInputs) == 0 && window->Rect().Contains(at))
      return true;
  return false;
}

bool Gui::wants_text_input() const {
  const ImGuiContext& context = *ImGui::GetCurrentContext();
  const bool typing = context.ActiveId != 0 && context.InputTextState.ID == context.ActiveId;
  return typing || ImGui::GetTopMostPopupModal() != nullptr;
}

bool Gui::close_popup() {
  const int open = ImGui::GetCurrentContext()->OpenPopupStack.Size;
  if (open > 0) ImGui::ClosePopupToLevel(open - 1, true);
  return open > 0;
}

void Gui::hide_pointer() { ImGui::SetMouseCursor(ImGuiMouseCursor_None); }

void Gui::show_hand_pointer() { ImGui::SetMouseCursor(ImGuiMouseCursor_Hand); }

bool Gui::is_busy() const { return ImGui::IsAnyItemActive() || ImGui::GetIO().WantTextInput; }

}  // namespace catena::app
