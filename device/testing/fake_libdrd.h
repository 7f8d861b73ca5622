#pragma once

/// A library of libdrd.so's C interface with one device behind it, whose firmware has a watchdog. As a real
/// one does, it acts on the last force that it took. Plain C data, since
/// it is reached through dlsym: `struct FakeDrd* fake_drd(void)`; `bool fake_drd_is_pushing(void)`; and
/// `void fake_drd_set_clock(double (*)(void))`, for a clock of the test's own. In a file that processes share where
/// $PALPATE_FAKE_DRD names one.

struct FakeDrd {
  int devices = 1;
  int type = 33;
  int serial = 1234;
  int major = 3;
  int homed = 1;
  int auto_inits = 0;
  int homing_fails = 0;
  double place[3] = {0, 0, 0};  // m, its own frame: x towards the user, y right, z up
  double force[3] = {0, 0, 0};  // N, as last set
  double set_time = 0;          // s
  double watchdog_s = 0;        // 0: off
  double max_force = 12;
  double told_max_force = 0;
  int expert = 0;
  int gravity = 0;
  int forces_on = 0;
  int stopped = 0;
  int closed = 0;
  int failing = 0;             // every call fails
  char failing_call[48] = "";  // or each call of this name alone; a force that is refused leaves the one before
  int in_error = 0;            // of its status
  unsigned buttons = 0;
  int has_wrist = 0;
  int unplugged = 0;  // nothing arrives any more; what the device does then is its firmware's
  int torques = 0;    // commands with a torque or a grip's force
  int opened = 0;
  double frame[3][3] = {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};  // of its wrist: a quarter turn about its z, x goes to y
  int frame_fails = 0, status_fails = 0;
  int status_reads = 0;
  int no_force = 0;      // of its status: the user has switched the forces off
  int status_size = 32;  // numbers that dhdGetStatus() writes; it has grown with the library
  int serial_fails = 0;
  int has_watchdog = 1;
  int is_regulating = 0;  // drdAutoInit() moves the arm by a regulation, whose last force stays until another is set
  char order[64] = "";    // of bringing it up: regulation stopped S, watchdog W, limit M, forces on E, zero 0, force F
};
