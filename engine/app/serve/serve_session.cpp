#include "engine/app/serve/serve_session.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "engine/app/serve/words.h"
#include "engine/base/clock.h"
#include "engine/base/tell.h"
#include "engine/base/text.h"

namespace catena::app {

namespace {

constexpr double kNobodyWaitS = 0.1, kLookWaitS = 0.004;  // between looks at the servo's news
constexpr double kStateMs = 50, kSceneMs = 500;

}  // namespace

ServeSession::ServeSession(const ServeOptions& options, const LoadedScene& loaded, SceneHost& scene, HandHost& hand, web::Server& server,
                           PictureMaker& maker, const Interrupt& interrupt)
    : options_(options),
      scene_(scene),
      hand_(hand),
      server_(server),
      maker_(maker),
      interrupt_(interrupt),
      pacing_(options.quality),
      drawing_(scene, controls_, pacing_),
      eye_(controls_, scene, hand),
      follower_(options.follow),
      width_(options.width),
      height_(options.height) {
  scene_.bounds = loaded.bounds;
  eye_.look_at(loaded);
  scene_.set_check([&hand](scene::Scene& edited) { return hand.check(edited); });
  scene_.take_changed();
  plan_.quality_stated = options.quality_stated;
}

namespace {

/// Who writes to it has gone; what it writes is of no interest.
bool stdin_has_ended() {
  pollfd in{STDIN_FILENO, POLLIN, 0};
  std::array<char, 4096> ignored{};
  while (poll(&in, 1, 0) > 0) {
    const ssize_t count = read(STDIN_FILENO, ignored.data(), ignored.size());
    if (count == 0 || (count < 0 && errno != EINTR)) return true;
  }
  return false;
}

}  // namespace

bool ServeSession::goes_on() const {
  if (options_.until_stdin_ends && stdin_has_ended()) return false;
  return !interrupt_.asked() && (options_.seconds <= 0 || 1e-3 * ms_since(start_ns_) < options_.seconds);
}

Outcome ServeSession::run() {
  CATENA_CHECK(plan_as_stated());
  start_ns_ = now_ns();
  bool busy = true;
  while (goes_on()) {
    for (const web::News& news : server_.take(viewers_.empty() ? kNobodyWaitS : busy ? 0 : kLookWaitS)) hear(news);
    for (const WidgetEdits::Ended& ended : widget_edits_.take(scene_.scene())) note_if_wrong(scene_.apply(ended.edits, ended.what));
    if (const auto more = follower_.run(scene_, steps_); !more) note(more.error().message);
    if (!viewers_.empty()) note_if_wrong(steps_.run(scene_));
    if (recording_.is_over(hand_)) end_recording();
    if (scene_.take_changed()) {
      note_if_wrong(follow_text(plan_, scene_, pacing_));
      note_if_wrong(hand_.publish(scene_.scene(), scene_.felt_text()));
      moved_ = true;
      scene_told_ = false;
    }
    hand_moved_ = hand_.take(scene_.scene()) || hand_moved_;
    if (viewers_.empty()) continue;
    moved_ = eye_.move({}) || moved_;
    const int before = times_.count();
    if (server_.wants_picture()) CATENA_CHECK(show_next());
    busy = times_.count() != before;
    tell_state();
  }
  CATENA_CHECK(recording_.end(hand_));
  const exchange::HapticState& felt = hand_.felt();
  fmt::print("{} pictures for at most {} page{} at a time, {:.1f} ms median, on {}\n", times_.count(), most_viewers_,
             most_viewers_ == 1 ? "" : "s", 1e-3 * times_.draw().p50_us, printable(maker_.renderer().stats().device));
  fmt::print("probe {:.6g} {:.6g} {:.6g}, force {:.3g} N, {} ticks, {} deadlines missed\n", felt.probe.x, felt.probe.y, felt.probe.z,
             norm(felt.force_n), felt.tick, felt.missed_deadlines);
  return Done{};
}

// ---- pictures ----

Outcome ServeSession::show_next() {
  const bool moved = std::exchange(moved_, false), hand_moved = std::exchange(hand_moved_, false);
  if (const auto next = drawing_.next(moved, hand_moved, width_, height_)) {
    if (const Outcome drawn = maker_.draw(drawing_, pacing_, times_, *next, width_, height_); !drawn) {
      if (drawn.error().machine) return drawn;
      note(drawn.error().message);  // an edit's: the last picture stands
      return Done{};
    }
    if (plan_.is_drawn_by(*next) && plan_.drawn(maker_.drawing_ms()))
      if (const auto quality = plan_.quality()) pacing_ = Pacing(*quality);
    return send_picture(false);
  }
  // it rests: what the pages have is as good as it gets, but for how it was encoded
  const bool rests = drawing_.rest_s() >= kRestS && 1e-3 * ms_since(last_picture_ns_) >= kRestS;
  return rests && !exact_ && maker_.has_picture() ? send_picture(true) : Outcome(Done{});
}

Outcome ServeSession::send_picture(bool exact) {
  CATENA_TRY(last_picture_, maker_.message(exact, motion_));
  exact_ = exact;
  last_picture_ns_ = now_ns();
  server_.send(web::kAllViewers, web::Slot::picture, last_picture_);
  return Done{};
}

// ---- pages ----

void ServeSession::hear(const web::News& news) {
  switch (news.what) {
    case web::News::What::came:
      return came(news.viewer);
    case web::News::What::left:
      return left(news.viewer);
    case web::News::What::said:
      break;
  }
  const auto wish = parse_wish(news.words);
  if (!wish) return server_.send(news.viewer, web::Slot::note, note_words(wish.error().message));
  const bool has_hand = news.viewer == holder_;
  if (const auto* about = std::get_if<HandWish>(&*wish)) {
    if (*about == HandWish::take && holder_ == 0) give_hand_to(news.viewer);
    if (*about == HandWish::give && has_hand) give_hand_to(0);
    return;
  }
  if (!has_hand) return;  // who watches changes nothing
  std::visit(
      [this](const auto& asked) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(asked)>, HandWish>) carry_out(asked);
      },
      *wish);
}

void ServeSession::came(web::ViewerId viewer) {
  viewers_.push_back(viewer);
  most_viewers_ = std::max(most_viewers_, viewers_.size());
  last_state_.clear();
  server_.send(viewer, web::Slot::scene, scene_words(scene_, values_));
  if (!last_picture_.empty()) server_.send(viewer, web::Slot::picture, last_picture_);
  if (holder_ == 0) return give_hand_to(viewer);
  tell_roles();
}

void ServeSession::left(web::ViewerId viewer) {
  std::erase(viewers_, viewer);
  if (viewer == holder_) return give_hand_to(0);
  tell_roles();
}

void ServeSession::give_hand_to(web::ViewerId viewer) {
  end_hand();
  controls_.turntable = false;
  holder_ = viewer;
  motion_ = 0;
  tell_roles();
}

void ServeSession::tell_roles() {
  for (const web::ViewerId viewer : viewers_)
    server_.send(viewer, web::Slot::role, role_words(viewer == holder_ ? "yours" : holder_ == 0 ? "free" : "taken", viewers_.size()));
}

void ServeSession::tell_state() {
  if (ms_since(last_state_ns_) < kStateMs) return;
  last_state_ns_ = now_ns();
  std::string state = state_words(hand_, scene_, {controls_.hand_mode, steps_.plays, pacing_.words(), plan_, recording_.name()});
  if (state != last_state_) server_.send(web::kAllViewers, web::Slot::state, state);
  last_state_ = std::move(state);
  // histograms come when they are sorted
  if ((scene_told_ && !values_.is_working()) || ms_since(last_scene_ns_) < kSceneMs) return;
  last_scene_ns_ = last_state_ns_;
  server_.send(web::kAllViewers, web::Slot::scene, scene_words(scene_, values_));
  scene_told_ = true;
}

void ServeSession::note(const std::string& line) {
  if (holder_ != 0) server_.send(holder_, web::Slot::note, note_words(line));
}

void ServeSession::note_if_wrong(const Outcome& outcome) {
  if (!outcome) note(outcome.error().message);
}

// ---- the plan ----

/// What the scene wants before anybody looks.
Outcome ServeSession::plan_as_stated() {
  plan_.wanted = plan_.stated = scene_.scene().plan;
  if (plan_.wanted.of_hand()) {
    CATENA_CHECK(measure_hand(plan_, scene_, hand_, [](const std::string& line) { tell_from_catena(line); }));
    scene_.touch();
  }
  return plan_.wanted.of_eye() && !plan_.quality_stated ? measure_eye_now() : Outcome(Done{});
}

Outcome ServeSession::measure_eye_now() {
  CATENA_TRY(const render::FramePacket packet, drawing_.packet(width_, height_));
  const auto tell = [this](const std::string& line) { viewers_.empty() ? tell_from_catena(line) : note(line); };
  return measure_eye(plan_, pacing_, maker_.renderer(), packet, scene_, hand_, tell);
}

}  // namespace catena::app
