#include "device/testing/fake_libdrd.h"

#include <cstring>
#include <ctime>

#include "device/testing/shared_state.h"

namespace {

FakeDrd& state = palpate::device::shared_state<FakeDrd>("PALPATE_FAKE_DRD");
double (*clock_of_test)() = nullptr;
void (*hook_of_test)(const char* call) = nullptr;

double now() {
  if (clock_of_test != nullptr) return clock_of_test();
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

int result(const char* call) {
  return state.failing != 0 || state.unplugged != 0 || std::strcmp(call, state.failing_call) == 0 ? -1 : 0;
}

/// What happens meanwhile.
void during(const char* call) {
  if (hook_of_test != nullptr) hook_of_test(call);
}

void note(char what) {
  const std::size_t length = std::strlen(state.order);
  if (length + 1 < sizeof state.order) state.order[length] = what;
}

void act(double fx, double fy, double fz) {
  state.force[0] = fx;
  state.force[1] = fy;
  state.force[2] = fz;
  state.set_time = now();
}

}  // namespace

extern "C" {

FakeDrd* fake_drd() {
  return &state;
}
void fake_drd_set_clock(double (*clock)()) {
  clock_of_test = clock;
}
void fake_drd_set_hook(void (*hook)(const char* call)) {
  hook_of_test = hook;
}
void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision) {
  *major = state.major;
  *minor = 17;
  *release = 5;
  *revision = 0;
}
int dhdGetDeviceCount() {
  return state.devices;
}
int dhdGetSystemType(char) {
  return state.type;
}
const char* dhdGetSystemName(char) {
  return "omega.3";
}
int dhdGetSerialNumber(unsigned short* serial, char id) {
  if (state.serial_fails != 0) return -1;
  *serial = static_cast<unsigned short>(state.serial + id);
  return 0;
}
const char* dhdErrorGetLastStr() {
  return "a fault of the fake";
}
int drdOpenID(char id) {
  if (id >= state.devices || id == state.unopenable) return -1;
  state.opened = state.opened + 1;
  during("drdOpenID");
  return id;
}
int drdClose(char) {
  during("drdClose");
  state.closed = state.closed + 1;
  return 0;
}
bool drdIsInitialized(char) {
  return state.homed != 0;
}
int drdAutoInit(char) {
  state.auto_inits = state.auto_inits + 1;
  during("drdAutoInit");
  if (state.homing_fails != 0) return -1;
  state.homed = 1;
  state.is_regulating = 1;
  state.forces_on = 1;
  act(0, 0, 0.7);  // it carries the arm
  return 0;
}
int drdStop(bool keep_forces, char) {
  during("drdStop");
  note('S');
  if (state.is_regulating == 0 || result("drdStop") < 0) return -1;
  state.is_regulating = 0;
  if (!keep_forces) state.forces_on = 0;
  return 0;
}
int dhdEnableExpertMode() {
  state.expert = 1;
  return 0;
}
int dhdSetWatchdog(unsigned char duration, char) {
  if (state.expert == 0 || state.has_watchdog == 0) return -1;
  note('W');
  state.watchdog_s = duration * 125e-6;
  return 0;
}
int dhdSetMaxForce(double newtons, char) {
  note('M');
  state.told_max_force = newtons;
  return 0;
}
double dhdGetMaxForce(char) {
  return state.max_force;
}
int dhdSetGravityCompensation(int on, char) {
  state.gravity = on;
  return 0;
}
int dhdEnableForce(unsigned char on, char) {
  note('E');
  state.forces_on = on;
  return result("dhdEnableForce");
}
int dhdStop(char id) {
  during("dhdStop");
  state.stopped = state.stopped + 1;
  if (id == state.unstoppable) return -1;
  if (state.unplugged == 0) state.forces_on = 0;
  return 0;
}
int dhdGetPosition(double* x, double* y, double* z, char) {
  *x = state.place[0];
  *y = state.place[1];
  *z = state.place[2];
  return result("dhdGetPosition");
}
int dhdGetOrientationFrame(double matrix[3][3], char) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) matrix[row][column] = state.frame[row][column];
  }
  return state.frame_fails != 0 ? -1 : 0;
}
bool dhdHasWrist(char) {
  return state.has_wrist != 0;
}
unsigned dhdGetButtonMask(char) {
  return state.buttons;
}
int dhdGetStatus(int* status, char) {
  for (int i = 0; i < state.status_size; ++i) status[i] = 0;
  status[5] = state.forces_on != 0 && state.no_force == 0 ? 1 : 0;
  status[9] = state.in_error;
  state.status_reads = state.status_reads + 1;
  return state.status_fails != 0 ? -1 : 0;
}
int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty, double tz, double grip,
                                        char) {
  if (result("dhdSetForceAndTorqueAndGripperForce") < 0) return -1;
  note(fx == 0 && fy == 0 && fz == 0 ? '0' : 'F');
  if (tx != 0 || ty != 0 || tz != 0 || grip != 0) state.torques = state.torques + 1;
  act(fx, fy, fz);
  return 0;
}
/// What pushes now: the firmware's watchdog takes a force away that is not renewed.
bool fake_drd_is_pushing() {
  const bool stale = state.watchdog_s > 0 && now() - state.set_time > state.watchdog_s;
  const bool any = state.force[0] != 0 || state.force[1] != 0 || state.force[2] != 0;
  return any && !stale && state.forces_on != 0;
}

}  // extern "C"
