#pragma once

/// A replacement for libHD.so with one device and a scheduler of 1 kHz. As in its manual, each thread has a stack of
/// errors, from which hdGetError() takes the newest, and an initialized device cannot be initialized again before it is
/// disabled (HD_DEVICE_ALREADY_INITIATED). Plain C data, accessed through dlsym: `struct FakeHd* fake_hd(void)`. `void
/// fake_hd_by_hand(bool)` stops the scheduler's thread, and `void fake_hd_call(void)` then runs one of its rounds. The
/// data are in the file named by $PALPATE_FAKE_HD, if it is set, which processes share.

struct FakeHd {
  int present = 1;
  // A failing call: each call of this name, after so many successful ones, puts the error on the stack.
  unsigned error = 0;
  char failing_call[32] = "hdEndFrame";
  int sound_calls = 0;
  unsigned at_init[4] = {};        // put on the stack by hdInitDevice, the last one on top; 0: none
  int styles = 4;                  // of calibration: encoder reset 1, automatic 2, inkwell 4
  unsigned calibration = 0x5000;   // result of hdCheckCalibration
  unsigned after_update = 0x5000;  // result after hdUpdateCalibration
  double place_mm[3] = {0, 0, 0};
  double transform[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};  // column by column
  double force[3] = {0, 0, 0};
  int buttons = 0;
  int stalled = 0;  // the scheduler makes no calls
  int enabled = 0;  // bits: forces 1, clamping 2, ramping 4
  int in_frame = 0;
  int misuses = 0;  // calls outside a frame, or in an order that the real library does not allow
  int running = 0;
  int disabled = 0;
  int callbacks = 0;
  char named[64] = {};
  int unplugged = 0;  // forces no longer arrive, and the library reports it
  int torques = 0;    // settings other than a force
  int scheduled = 0;  // callbacks that are still scheduled
  // Its reported properties.
  double force_newtons = 3.3, continuous_newtons = 0.88, stiffness_newtons_per_mm = 0.5;
  double box_mm[6] = {-80, -60, -35, 80, 60, 35};  // lowest x, y, z, highest x, y, z
  char model[64] = "PHANToM Omni";                 // empty: not reported
  // Its settings by the client.
  unsigned long rate_hz = 0;
  int priority = -1;
  unsigned made_current = 0, style = 0;
  int updates = 0;          // of the calibration
  double update_force = 0;  // N, during the latest update
};
