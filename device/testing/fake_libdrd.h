#pragma once

/// A replacement for libdrd.so with one device, whose firmware has a watchdog. Like a real device, it keeps applying
/// the latest force. Plain C data, accessed through dlsym: `struct FakeDrd* fake_drd(void)`; `bool
/// fake_drd_is_pushing(void)`; `void fake_drd_set_clock(double (*)(void))`, for a clock of the test; and `void
/// fake_drd_set_hook(void (*)(const char*))`, for what happens during the calls that open, home, stop or close a
/// device. The data are in the file named by $PALPATE_FAKE_DRD, if it is set, which processes share.

struct FakeDrd {
  int devices = 1;
  int type = 33;
  int serial = 1234;
  int major = 3;
  int homed = 1;
  int auto_inits = 0;
  int homing_fails = 0;
  double place[3] = {0, 0, 0};  // m, its own frame: x towards the user, y right, z up
  double force[3] = {0, 0, 0};  // N, latest
  double set_time = 0;          // s
  double watchdog_s = 0;        // 0: off
  double max_force = 12;
  double told_max_force = 0;
  int expert = 0;
  int gravity = 0;
  int forces_on = 0;
  int stopped = 0;
  int unstoppable = -1;  // the device, of several, that dhdStop() does not stop
  int unopenable = -1;   // that another program holds
  int closed = 0;
  int failing = 0;             // every call fails
  char failing_call[48] = "";  // or only calls of this name; a refused force leaves the previous one
  int in_error = 0;            // in its status
  unsigned buttons = 0;
  int has_wrist = 0;
  int unplugged = 0;  // commands no longer arrive; the device then does what its firmware does
  int torques = 0;    // commands with a torque or a gripper force
  int opened = 0;
  double frame[3][3] = {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};  // of its wrist: a quarter turn about its z, from x to y
  int frame_fails = 0, status_fails = 0;
  int status_reads = 0;
  int no_force = 0;      // in its status: the user has switched the forces off
  int status_size = 32;  // numbers that dhdGetStatus() writes; it depends on the library's version
  int serial_fails = 0;
  int has_watchdog = 1;
  int is_regulating = 0;  // drdAutoInit() moves the arm by a regulation, whose last force stays until another is set
  char order[64] = "";    // of starting up: regulation stopped S, watchdog W, limit M, forces on E, zero 0, force F
};
