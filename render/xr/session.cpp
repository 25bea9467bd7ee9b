#include "render/xr/session.h"

#include <algorithm>
#include <utility>

namespace catena::render::xr {

namespace {

constexpr std::size_t kHistory = 256;
constexpr std::chrono::seconds kLastPatience{5};

}  // namespace

Result<std::unique_ptr<Session>> Session::create(Instance& instance, vk::Device& device) {
  std::unique_ptr<Session> self(new Session(instance, device));
  XrGraphicsBindingVulkan2KHR binding{};
  binding.type = XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR;
  binding.instance = device.instance();
  binding.physicalDevice = device.physical();
  binding.device = device.handle();
  binding.queueFamilyIndex = device.queue_family();
  binding.queueIndex = 0;
  XrSessionCreateInfo info{};
  info.type = XR_TYPE_SESSION_CREATE_INFO;
  info.next = &binding;
  info.systemId = instance.system();
  {
    const auto turn = device.queue_turn();
    CATENA_XR_CHECK(instance, self->xr().CreateSession(instance.handle(), &info, &self->session_), "begin a session");
  }
  CATENA_CHECK(self->make_spaces());
  instance.session_is_new();
  return self;
}

FrameWait& Session::frame_wait() {
  if (!frame_wait_) frame_wait_ = std::make_unique<FrameWait>(xr().WaitFrame, session_);
  return *frame_wait_;
}

void Session::end_wait() {
  if (frame_wait_ && !frame_wait_->end(kLastPatience)) {
    instance_->leave_behind();
    device_->leave_behind();
  }
  frame_wait_.reset();
}

Session::~Session() {
  if (!session_) return;
  end_wait();
  for (XrSpace space : spaces_)
    if (space) (void)xr().DestroySpace(space);
  const auto turn = device_->queue_turn();
  (void)xr().DestroySession(session_);
}

Outcome Session::make_spaces() {
  std::uint32_t count = 0;
  CATENA_XR_CHECK(*instance_, xr().EnumerateReferenceSpaces(session_, 0, &count, nullptr), "list its spaces");
  std::vector<XrReferenceSpaceType> offered(count);
  CATENA_XR_CHECK(*instance_, xr().EnumerateReferenceSpaces(session_, count, &count, offered.data()), "list its spaces");
  constexpr XrReferenceSpaceType kTypes[] = {XR_REFERENCE_SPACE_TYPE_LOCAL, XR_REFERENCE_SPACE_TYPE_STAGE, XR_REFERENCE_SPACE_TYPE_VIEW};
  for (std::size_t k = 0; k < spaces_.size(); ++k) {
    if (std::ranges::find(offered, kTypes[k]) == offered.end()) continue;
    XrReferenceSpaceCreateInfo info{};
    info.type = XR_TYPE_REFERENCE_SPACE_CREATE_INFO;
    info.referenceSpaceType = kTypes[k];
    info.poseInReferenceSpace.orientation.w = 1;
    CATENA_XR_CHECK(*instance_, xr().CreateReferenceSpace(session_, &info, &spaces_[k]), "make a space");
  }
  if (!space(SpaceKind::local)) return Error{"the headset " + instance_->name() + " has no local space, expected one"};
  return Done{};
}

Outcome Session::enter(XrSessionState state) {
  if (!is_edge(state_, state)) ++odd_edges_;
  state_ = state;
  if (history_.size() == kHistory) history_.erase(history_.begin());
  history_.push_back(state);
  switch (act_on(state)) {
    case Act::begin: {
      XrSessionBeginInfo info{};
      info.type = XR_TYPE_SESSION_BEGIN_INFO;
      info.primaryViewConfigurationType = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
      CATENA_XR_CHECK(*instance_, xr().BeginSession(session_, &info), "begin to show");
      running_ = true;
      return Done{};
    }
    case Act::end:
      if (!std::exchange(running_, false)) return Done{};  // a runtime that says twice that it stops
      CATENA_XR_CHECK(*instance_, xr().EndSession(session_), "end the session");
      end_wait();  // what it says is of a session that is over
      return Done{};
    case Act::leave:
      running_ = false;
      has_left_ = true;
      return Done{};
    case Act::lost:
      running_ = false;
      return failed(XR_ERROR_SESSION_LOST, "keep its session");
    case Act::none:
      break;
  }
  return Done{};
}

Outcome Session::poll() {
  for (;;) {
    XrEventDataBuffer event{};
    event.type = XR_TYPE_EVENT_DATA_BUFFER;
    const XrResult polled = xr().PollEvent(instance_->handle(), &event);
    if (XR_FAILED(polled)) return failed(polled, "say what happened");
    if (polled == XR_EVENT_UNAVAILABLE) return Done{};
    switch (event.type) {
      case XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED: {
        const auto& changed = reinterpret_cast<const XrEventDataSessionStateChanged&>(event);
        if (changed.session == session_) CATENA_CHECK(enter(changed.state));
        break;
      }
      case XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING:
        running_ = false;
        return failed(XR_ERROR_INSTANCE_LOST, "keep its runtime");
      case XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING:
        ++recentrings_;
        break;
      case XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR:
        ++mask_changes_;
        break;
      case XR_TYPE_EVENT_DATA_INTERACTION_PROFILE_CHANGED:
        ++profile_changes_;
        break;
      default:
        break;
    }
  }
}

Result<std::optional<RoomPose>> Session::locate(XrSpace space, XrTime at, const char* what) {
  constexpr XrSpaceLocationFlags kKnown = XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT;
  XrSpaceLocation found{};
  found.type = XR_TYPE_SPACE_LOCATION;
  CATENA_XR_CHECK(*instance_, xr().LocateSpace(space, this->space(SpaceKind::local), at, &found), what);
  const auto& [x, y, z, w] = found.pose.orientation;
  const Vec3 position(found.pose.position.x, found.pose.position.y, found.pose.position.z);
  const Quat turn = normalised(Quat(w, x, y, z));
  if ((found.locationFlags & kKnown) != kKnown || !is_finite(position)) return std::optional<RoomPose>();
  return std::optional<RoomPose>({position, turn});
}

Outcome Session::ask_to_leave() {
  if (!running_) return Done{};
  CATENA_XR_CHECK(*instance_, xr().RequestExitSession(session_), "end the session");
  return Done{};
}

}  // namespace catena::render::xr
