// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>
#include <utility>

#include "tests/xr_runtime/runtime.h"

namespace catena::test::xr_runtime {

namespace {

XRAPI_ATTR XrResult XRAPI_CALL create_session(XrInstance handle, const XrSessionCreateInfo* info, XrSession* made) {
  ENTER(xrCreateSession);
  FIND(InstanceObject, instance, handle, instance);
  if (!instance->requirements_queried)
    return illegal(self, XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING, "the requirements were not asked for");
  const auto* binding = static_cast<const XrGraphicsBindingVulkan2KHR*>(info->next);
  if (!binding || binding->type != XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR)
    return illegal(self, XR_ERROR_GRAPHICS_DEVICE_INVALID, "no device");
  auto session = std::make_unique<SessionObject>(number(handle));
  session->instance = binding->instance;
  session->physical = binding->physicalDevice;
  session->device = binding->device;
  session->family = binding->queueFamilyIndex;
  vkGetDeviceQueue(binding->device, binding->queueFamilyIndex, binding->queueIndex, &session->queue);
  session->time = clock_now();
  SessionObject& captured = *session;
  const std::uint64_t id = world().add(std::move(session));
  *made = as_handle<XrSession>(id);
  post_state(id, captured, XR_SESSION_STATE_IDLE);
  post_state(id, captured, XR_SESSION_STATE_READY);
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL destroy_session(XrSession handle) {
  ENTER_TO_DESTROY(xrDestroySession);
  FIND(SessionObject, session, handle, session);
  auto* instance = world().find<InstanceObject>(session->parent, Kind::instance);
  std::erase_if(instance->events, [&](const XrEventDataBuffer& event) {
    return event.type == XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED &&
           reinterpret_cast<const XrEventDataSessionStateChanged&>(event).session == handle;
  });
  world().remove(number(handle));
  return answer;
}

XRAPI_ATTR XrResult XRAPI_CALL begin_session(XrSession handle, const XrSessionBeginInfo* info) {
  ENTER(xrBeginSession);
  FIND(SessionObject, session, handle, session);
  if (info->primaryViewConfigurationType != XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO)
    return illegal(self, XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED, "no such views");
  if (session->running) return illegal(self, XR_ERROR_SESSION_RUNNING, "it runs");
  if (session->state != XR_SESSION_STATE_READY) return illegal(self, XR_ERROR_SESSION_NOT_READY, "it is not ready");
  session->running = true;
  session->waited = session->begun = session->has_shown_frame = session->exit_requested = false;
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL end_session(XrSession handle) {
  ENTER(xrEndSession);
  FIND(SessionObject, session, handle, session);
  if (!session->running) return illegal(self, XR_ERROR_SESSION_NOT_RUNNING, "it does not run");
  if (session->state != XR_SESSION_STATE_STOPPING) return illegal(self, XR_ERROR_SESSION_NOT_STOPPING, "it is not stopping");
  session->running = false;
  post_state(number(handle), *session, XR_SESSION_STATE_IDLE);
  if (session->exit_requested) post_state(number(handle), *session, XR_SESSION_STATE_EXITING);
  for (const XrSessionState state : std::exchange(world().shared.script.after_end, {})) post_state(number(handle), *session, state);
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL request_exit(XrSession handle) {
  ENTER(xrRequestExitSession);
  FIND(SessionObject, session, handle, session);
  if (!session->running) return illegal(self, XR_ERROR_SESSION_NOT_RUNNING, "it does not run");
  session->exit_requested = true;
  if (session->state == XR_SESSION_STATE_STOPPING) return XR_SUCCESS;
  if (session->state == XR_SESSION_STATE_FOCUSED) post_state(number(handle), *session, XR_SESSION_STATE_VISIBLE);
  if (session->state == XR_SESSION_STATE_VISIBLE) post_state(number(handle), *session, XR_SESSION_STATE_SYNCHRONIZED);
  post_state(number(handle), *session, XR_SESSION_STATE_STOPPING);
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL reference_spaces(XrSession handle, std::uint32_t capacity, std::uint32_t* count, XrReferenceSpaceType* out) {
  ENTER(xrEnumerateReferenceSpaces);
  FIND(SessionObject, session, handle, session);
  std::vector all{XR_REFERENCE_SPACE_TYPE_VIEW, XR_REFERENCE_SPACE_TYPE_LOCAL};
  if (!world().shared.script.unsupported.contains("stage")) all.push_back(XR_REFERENCE_SPACE_TYPE_STAGE);
  return fill(all, capacity, count, out);
}

XRAPI_ATTR XrResult XRAPI_CALL create_space(XrSession handle, const XrReferenceSpaceCreateInfo* info, XrSpace* made) {
  ENTER(xrCreateReferenceSpace);
  FIND(SessionObject, session, handle, session);
  auto space = std::make_unique<SpaceObject>(number(handle));
  space->reference = info->referenceSpaceType;
  space->offset = info->poseInReferenceSpace;
  *made = as_handle<XrSpace>(world().add(std::move(space)));
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL destroy_space(XrSpace handle) {
  ENTER_TO_DESTROY(xrDestroySpace);
  FIND(SpaceObject, space, handle, space);
  world().remove(number(handle));
  return answer;
}

/// Poses are scripted in the local space; the head is midway between the views.
XRAPI_ATTR XrResult XRAPI_CALL locate_space(XrSpace handle, XrSpace base, XrTime time, XrSpaceLocation* out) {
  ENTER(xrLocateSpace);
  FIND(SpaceObject, space, handle, space);
  FIND(SpaceObject, in, base, space);
  if (time <= 0) return illegal(self, XR_ERROR_TIME_INVALID, "no such time");
  const Script& script = world().shared.script;
  constexpr XrSpaceLocationFlags kAll = XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT |
                                        XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;
  out->locationFlags = script.tracked ? kAll : 0;
  out->pose = {{0, 0, 0, 1}, {0, 0, 0}};
  if (space->action != 0) {
    const ScriptedHand& hand = script.hands[space->hand];
    const auto* action = world().find<ActionObject>(space->action, Kind::action);
    const bool of_eyes = action && action->name == "gaze";
    if (!action || !(of_eyes ? script.gaze.has_value() : hand.active)) out->locationFlags = 0;
    if (action) out->pose = action->name.find("aim") != std::string::npos ? hand.aim : hand.grip;
    if (of_eyes && script.gaze) out->pose = *script.gaze;
  } else if (space->reference == XR_REFERENCE_SPACE_TYPE_VIEW && !script.views.empty()) {
    XrVector3f sum{0, 0, 0};
    for (const XrView& view : script.views) {
      sum.x += view.pose.position.x / float(script.views.size());
      sum.y += view.pose.position.y / float(script.views.size());
      sum.z += view.pose.position.z / float(script.views.size());
    }
    out->pose.position = sum;
  } else if (space->reference == XR_REFERENCE_SPACE_TYPE_STAGE) {
    out->pose = script.stage;
  }
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL wait_frame(XrSession handle, const XrFrameWaitInfo*, XrFrameState* out) {
  std::function<void(std::uint64_t, Script&)> at_frame;
  std::int64_t sleep_ns = 0;
  {
    ENTER(xrWaitFrame);
    FIND(SessionObject, session, handle, session);
    if (!session->running) return illegal(self, XR_ERROR_SESSION_NOT_RUNNING, "it does not run");
    if (session->waited) return illegal(self, XR_ERROR_CALL_ORDER_INVALID, "the last frame was not begun");
    Script& script = world().shared.script;
    const std::uint64_t frame = session->frame++;
    if (script.on_frame) script.on_frame(frame, script);
    if (script.slow_wait && script.slow_wait->first == frame) sleep_ns = script.slow_wait->second;
    if (script.menu_to > 0) script.hands[1].menu = frame >= script.menu_from && frame < script.menu_to;
    if (const auto grip = script.grip_path.find(frame); grip != script.grip_path.end()) script.hands[1].grip.position = grip->second;
    if (!script.select_frames.empty())
      script.hands[1].select =
          std::ranges::any_of(script.select_frames, [&](const auto& of) { return frame >= of.first && frame < of.second; });
    for (auto [it, end] = script.states.equal_range(frame); it != end; ++it) post_state(number(handle), *session, it->second);
    auto* instance = world().find<InstanceObject>(session->parent, Kind::instance);
    for (auto [it, end] = script.events.equal_range(frame); it != end; ++it) instance->events.push_back(it->second);
    session->waited = true;
    session->located.clear();
    const XrTime now = clock_now();
    session->time += std::max<std::int64_t>(script.period_ns, 1);  // the next frame is later for any period
    if (script.sleeps_in_wait) {
      if (session->time > now) sleep_ns = std::max(sleep_ns, session->time - now);
      if (session->time < now - script.period_ns) session->time = now;  // late: moves to the next refresh
    }
    out->predictedDisplayTime = session->time + script.period_ns;
    out->predictedDisplayPeriod = script.reported_period_ns.value_or(script.period_ns);
    out->shouldRender = session->state == XR_SESSION_STATE_VISIBLE || session->state == XR_SESSION_STATE_FOCUSED;
  }
  if (sleep_ns > 0) std::this_thread::sleep_for(std::chrono::nanoseconds(sleep_ns));
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL begin_frame(XrSession handle, const XrFrameBeginInfo*) {
  ENTER(xrBeginFrame);
  FIND(SessionObject, session, handle, session);
  if (!session->running) return illegal(self, XR_ERROR_SESSION_NOT_RUNNING, "it does not run");
  if (!session->waited) return illegal(self, XR_ERROR_CALL_ORDER_INVALID, "it was not waited for");
  session->waited = false;
  return std::exchange(session->begun, true) ? XR_FRAME_DISCARDED : XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL locate_views(XrSession handle, const XrViewLocateInfo* info, XrViewState* state, std::uint32_t capacity,
                                            std::uint32_t* count, XrView* out) {
  ENTER(xrLocateViews);
  FIND(SessionObject, session, handle, session);
  FIND(SpaceObject, space, info->space, space);
  if (info->displayTime <= 0) return illegal(self, XR_ERROR_TIME_INVALID, "no such time");
  const Script& script = world().shared.script;
  state->viewStateFlags = script.tracked ? XR_VIEW_STATE_ORIENTATION_VALID_BIT | XR_VIEW_STATE_POSITION_VALID_BIT : 0;
  session->located = script.views;
  return fill(script.views, capacity, count, out);
}

bool is_same(const XrCompositionLayerProjectionView& shown, const XrView& located) {
  return std::memcmp(&shown.pose, &located.pose, sizeof(XrPosef)) == 0 && std::memcmp(&shown.fov, &located.fov, sizeof(XrFovf)) == 0;
}

const char* fault_of(const XrSwapchainSubImage& sub) {
  const auto* swapchain = world().find<SwapchainObject>(number(sub.swapchain), Kind::swapchain);
  if (!swapchain) return "no such swapchain";
  if (!swapchain->released) return "a swapchain of which no image was released";
  const XrRect2Di& rect = sub.imageRect;
  const bool inside = rect.offset.x >= 0 && rect.offset.y >= 0 && rect.extent.width > 0 && rect.extent.height > 0 &&
                      rect.offset.x + rect.extent.width <= int(swapchain->info.width) &&
                      rect.offset.y + rect.extent.height <= int(swapchain->info.height);
  return inside ? nullptr : "a rectangle beyond the image";
}

void keep(SessionObject& session, const XrCompositionLayerProjectionView& view, const XrCompositionLayerDepthInfoKHR* depth,
          CapturedImage& captured) {
  auto* swapchain = world().find<SwapchainObject>(number(view.subImage.swapchain), Kind::swapchain);
  read_back(session, *swapchain, view.subImage.imageRect, captured);
  captured.pose = view.pose;
  captured.fov = view.fov;
  if (!depth) return;
  read_back(session, *world().find<SwapchainObject>(number(depth->subImage.swapchain), Kind::swapchain), depth->subImage.imageRect,
            captured);
  captured.near_z = depth->nearZ;
  captured.far_z = depth->farZ;
  captured.min_depth = depth->minDepth;
  captured.max_depth = depth->maxDepth;
}

XRAPI_ATTR XrResult XRAPI_CALL end_frame(XrSession handle, const XrFrameEndInfo* info) {
  ENTER(xrEndFrame);
  FIND(SessionObject, session, handle, session);
  if (!session->running) return illegal(self, XR_ERROR_SESSION_NOT_RUNNING, "it does not run");
  if (!session->begun) return illegal(self, XR_ERROR_CALL_ORDER_INVALID, "it was not begun");
  if (info->displayTime <= session->last_ended) return illegal(self, XR_ERROR_TIME_INVALID, "not after the last frame's time");
  SharedState& stage = world().shared;
  for (std::uint32_t l = 0; l < info->layerCount; ++l) {
    const XrCompositionLayerBaseHeader* layer = info->layers[l];
    if (!world().find<SpaceObject>(number(layer->space), Kind::space)) return illegal(self, XR_ERROR_HANDLE_INVALID, "no such space");
    if (layer->type == XR_TYPE_COMPOSITION_LAYER_QUAD) {
      const auto& quad = reinterpret_cast<const XrCompositionLayerQuad&>(*layer);
      if (const char* fault = fault_of(quad.subImage)) return illegal(self, XR_ERROR_LAYER_INVALID, fault);
      ++stage.record.quads;
      if (!stage.script.capture_images) continue;
      stage.record.last_quad_images.assign(1, {});
      read_back(*session, *world().find<SwapchainObject>(number(quad.subImage.swapchain), Kind::swapchain), quad.subImage.imageRect,
                stage.record.last_quad_images[0]);
      stage.record.last_quad_images[0].pose = quad.pose;
      continue;
    }
    if (layer->type != XR_TYPE_COMPOSITION_LAYER_PROJECTION) return illegal(self, XR_ERROR_LAYER_INVALID, "no such layer");
    const auto& projection = reinterpret_cast<const XrCompositionLayerProjection&>(*layer);
    if (projection.viewCount != stage.script.views.size()) return illegal(self, XR_ERROR_VALIDATION_FAILURE, "another number of views");
    if (stage.script.capture_images) stage.record.last_images.assign(projection.viewCount, {});
    for (std::uint32_t k = 0; k < projection.viewCount; ++k) {
      const XrCompositionLayerProjectionView& view = projection.views[k];
      const auto* depth = static_cast<const XrCompositionLayerDepthInfoKHR*>(view.next);
      if (depth && depth->type != XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR) depth = nullptr;
      if (const char* fault = fault_of(view.subImage)) return illegal(self, XR_ERROR_LAYER_INVALID, fault);
      if (const char* fault = depth ? fault_of(depth->subImage) : nullptr) return illegal(self, XR_ERROR_LAYER_INVALID, fault);
      if (depth) ++stage.record.depths;
      if (k >= session->located.size() || !is_same(view, session->located[k])) ++stage.record.moved_poses;
      if (stage.script.capture_images) keep(*session, view, depth, stage.record.last_images[k]);
    }
    ++stage.record.projection_frames;
  }
  session->begun = false;
  session->last_ended = info->displayTime;
  ++stage.record.frames;
  if (!std::exchange(session->has_shown_frame, true)) {
    post_state(number(handle), *session, XR_SESSION_STATE_SYNCHRONIZED);
    if (stage.script.focus) {
      post_state(number(handle), *session, XR_SESSION_STATE_VISIBLE);
      post_state(number(handle), *session, XR_SESSION_STATE_FOCUSED);
    }
  }
  return XR_SUCCESS;
}

/// Visibility mask with two triangles that hide the lower left corner, in the plane z = -1.
XRAPI_ATTR XrResult XRAPI_CALL visibility_mask(XrSession handle, XrViewConfigurationType, std::uint32_t view, XrVisibilityMaskTypeKHR type,
                                               XrVisibilityMaskKHR* out) {
  ENTER(xrGetVisibilityMaskKHR);
  FIND(SessionObject, session, handle, session);
  const Script& script = world().shared.script;
  if (view >= script.views.size()) return illegal(self, XR_ERROR_INDEX_OUT_OF_RANGE, "no such view");
  if (type != XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR) return XR_ERROR_FEATURE_UNSUPPORTED;
  const XrFovf& fov = script.views[view].fov;
  const float l = std::tan(fov.angleLeft), d = std::tan(fov.angleDown), w = std::tan(fov.angleRight) - l, h = std::tan(fov.angleUp) - d;
  const std::vector<XrVector2f> vertices{{l, d}, {l + 0.3f * w, d}, {l, d + 0.3f * h}};
  const std::vector<std::uint32_t> indices{0, 1, 2};
  const XrResult first = fill(vertices, out->vertexCapacityInput, &out->vertexCountOutput, out->vertices);
  const XrResult second = fill(indices, out->indexCapacityInput, &out->indexCountOutput, out->indices);
  return XR_FAILED(first) ? first : second;
}

}  // namespace

PFN_xrVoidFunction find_session_function(const std::string& name) {
  static const std::map<std::string, PFN_xrVoidFunction> all{
      {"xrCreateSession", reinterpret_cast<PFN_xrVoidFunction>(create_session)},
      {"xrDestroySession", reinterpret_cast<PFN_xrVoidFunction>(destroy_session)},
      {"xrBeginSession", reinterpret_cast<PFN_xrVoidFunction>(begin_session)},
      {"xrEndSession", reinterpret_cast<PFN_xrVoidFunction>(end_session)},
      {"xrRequestExitSession", reinterpret_cast<PFN_xrVoidFunction>(request_exit)},
      {"xrEnumerateReferenceSpaces", reinterpret_cast<PFN_xrVoidFunction>(reference_spaces)},
      {"xrCreateReferenceSpace", reinterpret_cast<PFN_xrVoidFunction>(create_space)},
      {"xrDestroySpace", reinterpret_cast<PFN_xrVoidFunction>(destroy_space)},
      {"xrLocateSpace", reinterpret_cast<PFN_xrVoidFunction>(locate_space)},
      {"xrWaitFrame", reinterpret_cast<PFN_xrVoidFunction>(wait_frame)},
      {"xrBeginFrame", reinterpret_cast<PFN_xrVoidFunction>(begin_frame)},
      {"xrLocateViews", reinterpret_cast<PFN_xrVoidFunction>(locate_views)},
      {"xrEndFrame", reinterpret_cast<PFN_xrVoidFunction>(end_frame)},
      {"xrGetVisibilityMaskKHR", reinterpret_cast<PFN_xrVoidFunction>(visibility_mask)}};
  const auto it = all.find(name);
  return it == all.end() ? nullptr : it->second;
}

}  // namespace catena::test::xr_runtime
