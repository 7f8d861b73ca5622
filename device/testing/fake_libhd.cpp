#include "device/testing/fake_libhd.h"

#include <atomic>
#include <chrono>
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

void call_back() {
  if (state.stalled != 0 || callback == nullptr || state.running == 0) return;
  // HD_CALLBACK_CONTINUE is 1; whoever returns anything else is not called again.
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
  if (state.present == 0) {
    state.error = 0x302;
    return 0xffffffffU;
  }
  return 7;
}
void hdDisableDevice(unsigned) {
  if (state.running != 0) state.misuses = state.misuses + 1;
  state.disabled = state.disabled + 1;
}
void hdMakeCurrentDevice(unsigned device) {
  state.made_current = device;
}
void hdBeginFrame(unsigned) {
  state.in_frame = 1;
}
void hdEndFrame(unsigned) {
  state.in_frame = 0;
}
ErrorInfo hdGetError() {
  if (state.sound_answers > 0) {
    --state.sound_answers;
    return {0, 0, 7};
  }
  const ErrorInfo info = {state.unplugged != 0 ? 0x302U : state.error, 0, 7};
  return info;
}
const char* hdGetErrorString(unsigned) {
  return "a fault of the fake";
}
void hdEnable(unsigned what) {
  state.enabled |= 1 << (what - 0x4000);
}
void hdGetDoublev(unsigned what, double* values) {
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
  *values = what == 0x2000 ? state.buttons : 4;
}
const char* hdGetString(unsigned) {
  return state.model[0] != 0 ? state.model : nullptr;
}
void hdSetDoublev(unsigned what, const double* values) {
  must_be_in_frame();
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
}
void hdStartScheduler() {
  state.running = 1;
  stop = false;
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
