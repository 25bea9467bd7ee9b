// SPDX-License-Identifier: MIT
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
    const auto turn = device.lock_queue();
    CATENA_XR_CHECK(instance, self->dispatch().CreateSession(instance.handle(), &info, &self->session_), "create a session");
  }
  CATENA_CHECK(self->create_spaces());
  instance.clear_session_loss();
  return self;
}

FrameWaiter& Session::frame_waiter() {
  if (!frame_waiter_) frame_waiter_ = std::make_unique<FrameWaiter>(dispatch().WaitFrame, session_);
  return *frame_waiter_;
}

void Session::stop_wait() {
  if (frame_waiter_ && !frame_waiter_->stop(kLastPatience)) {
    instance_->abandon();
    device_->abandon();
  }
  frame_waiter_.reset();
}

Session::~Session() {
  if (!session_) return;
  stop_wait();
  for (XrSpace space : spaces_)
    if (space) (void)dispatch().DestroySpace(space);
  const auto turn = device_->lock_queue();
  (void)dispatch().DestroySession(session_);
}

Outcome Session::create_spaces() {
  std::uint32_t count = 0;
  CATENA_XR_CHECK(*instance_, dispatch().EnumerateReferenceSpaces(session_, 0, &count, nullptr), "list its reference spaces");
  std::vector<XrReferenceSpaceType> offered(count);
  CATENA_XR_CHECK(*instance_, dispatch().EnumerateReferenceSpaces(session_, count, &count, offered.data()), "list its reference spaces");
  constexpr XrReferenceSpaceType kTypes[] = {XR_REFERENCE_SPACE_TYPE_LOCAL, XR_REFERENCE_SPACE_TYPE_STAGE, XR_REFERENCE_SPACE_TYPE_VIEW};
  for (std::size_t k = 0; k < spaces_.size(); ++k) {
    if (std::ranges::find(offered, kTypes[k]) == offered.end()) continue;
    XrReferenceSpaceCreateInfo info{};
    info.type = XR_TYPE_REFERENCE_SPACE_CREATE_INFO;
    info.referenceSpaceType = kTypes[k];
    info.poseInReferenceSpace.orientation.w = 1;
    CATENA_XR_CHECK(*instance_, dispatch().CreateReferenceSpace(session_, &info, &spaces_[k]), "create a reference space");
  }
  if (!space(SpaceKind::local)) return Error{"the headset " + instance_->name() + " has no local space, expected one"};
  return Done{};
}

Outcome Session::enter_state(XrSessionState state) {
  if (!is_valid_transition(state_, state)) ++invalid_transitions_;
  state_ = state;
  if (state_history_.size() == kHistory) state_history_.erase(state_history_.begin());
  state_history_.push_back(state);
  switch (session_action(state)) {
    case SessionAction::begin: {
      XrSessionBeginInfo info{};
      info.type = XR_TYPE_SESSION_BEGIN_INFO;
      info.primaryViewConfigurationType = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
      CATENA_XR_CHECK(*instance_, dispatch().BeginSession(session_, &info), "begin the session");
      is_running_ = true;
      return Done{};
    }
    case SessionAction::end:
      if (!std::exchange(is_running_, false)) return Done{};  // the runtime reports the end twice
      CATENA_XR_CHECK(*instance_, dispatch().EndSession(session_), "end the session");
      stop_wait();  // a pending result belongs to the ended session
      return Done{};
    case SessionAction::exit:
      is_running_ = false;
      has_exited_ = true;
      return Done{};
    case SessionAction::lost:
      is_running_ = false;
      return failed(XR_ERROR_SESSION_LOST, "keep its session");
    case SessionAction::none:
      break;
  }
  return Done{};
}

Outcome Session::poll() {
  for (;;) {
    XrEventDataBuffer event{};
    event.type = XR_TYPE_EVENT_DATA_BUFFER;
    const XrResult polled = dispatch().PollEvent(instance_->handle(), &event);
    if (XR_FAILED(polled)) return failed(polled, "report its events");
    if (polled == XR_EVENT_UNAVAILABLE) return Done{};
    switch (event.type) {
      case XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED: {
        const auto& changed = reinterpret_cast<const XrEventDataSessionStateChanged&>(event);
        if (changed.session == session_) CATENA_CHECK(enter_state(changed.state));
        break;
      }
      case XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING:
        is_running_ = false;
        return failed(XR_ERROR_INSTANCE_LOST, "keep its runtime");
      case XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING:
        ++recenter_count_;
        break;
      case XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR:
        ++mask_change_count_;
        break;
      case XR_TYPE_EVENT_DATA_INTERACTION_PROFILE_CHANGED:
        ++profile_change_count_;
        break;
      default:
        break;
    }
  }
}

Result<std::optional<XrPose>> Session::locate(XrSpace space, XrTime at, const char* what) {
  constexpr XrSpaceLocationFlags kKnown = XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT;
  XrSpaceLocation found{};
  found.type = XR_TYPE_SPACE_LOCATION;
  CATENA_XR_CHECK(*instance_, dispatch().LocateSpace(space, this->space(SpaceKind::local), at, &found), what);
  const auto& [x, y, z, w] = found.pose.orientation;
  const Vec3 position(found.pose.position.x, found.pose.position.y, found.pose.position.z);
  const Quat turn = normalized(Quat(w, x, y, z));
  if ((found.locationFlags & kKnown) != kKnown || !is_finite(position)) return std::optional<XrPose>();
  return std::optional<XrPose>({position, turn});
}

Outcome Session::request_exit() {
  if (!is_running_) return Done{};
  CATENA_XR_CHECK(*instance_, dispatch().RequestExitSession(session_), "end the session");
  return Done{};
}

}  // namespace catena::render::xr
