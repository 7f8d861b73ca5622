#include "device/testing/fake_libhd.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>

#include "device/testing/shared_state.h"

namespace {

struct ErrorInfo {
  unsigned code;
  int internal;
  unsigned device;
};

FakeHd& state = palpate::device::shared_state<FakeHd>("PALPATE_FAKE_HD");
unsigned (*callback)(void*) = nullptr;
void* callback_data = nullptr;
std::atomic<bool> stop{false};
std::thread scheduler;
bool by_hand = false;
bool is_initialized = false;  // in this process

constexpr int deepest = 64;
thread_local unsigned errors[deepest];
thread_local int depth = 0;

void put_error(unsigned code) {
  if (depth < deepest) errors[depth++] = code;
}

void called(const char* name) {
  if (state.error == 0 || std::strcmp(name, state.failing_call) != 0) return;
  if (state.sound_calls > 0) {
    state.sound_calls = state.sound_calls - 1;
  } else {
    put_error(state.error);
  }
}

void call_back() {
  if (state.stalled != 0 || callback == nullptr || state.running == 0) return;
  // HD_CALLBACK_CONTINUE is 1; a callback that returns any other value is not called again.
  if (callback(callback_data) != 1) callback = nullptr;
  state.callbacks = state.callbacks + 1;
}

void run() {
  while (!stop) {
    call_back();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

void must_be_in_frame() {
  if (state.in_frame == 0) state.misuses = state.misuses + 1;
}

}  // namespace

extern "C" {

FakeHd* fake_hd() {
  return &state;
}
void fake_hd_by_hand(bool on) {
  by_hand = on;
}
void fake_hd_call() {
  call_back();
}
unsigned hdInitDevice(const char* name) {
  if (name != nullptr) std::strncpy(state.named, name, sizeof state.named - 1);
  if (state.present == 0 || is_initialized) {
    put_error(is_initialized ? 0x301 : 0x302);
    return 0xffffffffU;
  }
  is_initialized = true;
  for (const unsigned code : state.at_init) {
    if (code != 0) put_error(code);
  }
  called("hdInitDevice");
  return 7;
}
void hdDisableDevice(unsigned) {
  if (state.running != 0) state.misuses = state.misuses + 1;
  state.disabled = state.disabled + 1;
  is_initialized = false;
}
void hdMakeCurrentDevice(unsigned device) {
  state.made_current = device;
}
void hdBeginFrame(unsigned) {
  state.in_frame = 1;
}
void hdEndFrame(unsigned) {
  state.in_frame = 0;
  if (state.unplugged != 0) put_error(0x302);
  called("hdEndFrame");
}
ErrorInfo hdGetError() {
  return {depth > 0 ? errors[--depth] : 0, 0, 7};
}
const char* hdGetErrorString(unsigned) {
  return "a fault of the fake";
}
void hdEnable(unsigned what) {
  state.enabled |= 1 << (what - 0x4000);
  called("hdEnable");
}
void hdGetDoublev(unsigned what, double* values) {
  called("hdGetDoublev");
  switch (what) {
    case 0x2050:
      must_be_in_frame();
      for (int i = 0; i < 3; ++i) values[i] = state.place_mm[i];
      break;
    case 0x2052:
      for (int i = 0; i < 16; ++i) values[i] = state.transform[i];
      break;
    case 0x2603:
      *values = state.force_newtons;
      break;
    case 0x2604:
      *values = state.continuous_newtons;
      break;
    case 0x2602:
      *values = state.stiffness_newtons_per_mm;
      break;
    case 0x2551:
      for (int i = 0; i < 6; ++i) values[i] = state.box_mm[i];
      break;
    default:
      state.misuses = state.misuses + 1;
  }
}
void hdGetIntegerv(unsigned what, int* values) {
  called("hdGetIntegerv");
  *values = what == 0x2000 ? state.buttons : state.styles;
}
const char* hdGetString(unsigned) {
  return state.model[0] != 0 ? state.model : nullptr;
}
void hdSetDoublev(unsigned what, const double* values) {
  must_be_in_frame();
  called("hdSetDoublev");
  if (what != 0x2700) state.torques = state.torques + 1;
  if (what != 0x2700 || state.unplugged != 0) return;
  for (int i = 0; i < 3; ++i) state.force[i] = values[i];
}
unsigned hdCheckCalibration() {
  return state.calibration;
}
void hdUpdateCalibration(unsigned style) {
  state.style = style;
  state.updates = state.updates + 1;
  state.calibration = state.after_update;
  state.update_force = std::hypot(state.force[0], state.force[1], state.force[2]);
  // A device accepts one style at a time, and only a supported one.
  if ((style & (style - 1)) != 0 || (static_cast<int>(style) & state.styles) == 0) put_error(0x101);
  called("hdUpdateCalibration");
}
void hdStartScheduler() {
  state.running = 1;
  stop = false;
  called("hdStartScheduler");
  if (!by_hand) scheduler = std::thread(run);
}
void hdStopScheduler() {
  stop = true;
  if (scheduler.joinable()) scheduler.join();
  state.running = 0;
}
void hdSetSchedulerRate(unsigned long hz) {
  state.rate_hz = hz;
}
unsigned long hdScheduleAsynchronous(unsigned (*function)(void*), void* data, unsigned short priority) {
  state.priority = priority;
  callback = function;
  callback_data = data;
  state.scheduled = state.scheduled + 1;
  return 1;
}
void hdUnschedule(unsigned long) {
  if (state.running != 0) state.misuses = state.misuses + 1;
  callback = nullptr;
  state.scheduled = state.scheduled - 1;
}

}  // extern "C"
