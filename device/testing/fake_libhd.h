#pragma once

/// A library of libHD.so's C interface with one device behind it and a scheduler of 1 kHz. As its manual has it, each
/// thread has a stack of errors, of which hdGetError() takes the newest, and a device that is initialized is not
/// initialized again before it is disabled (HD_DEVICE_ALREADY_INITIATED). Plain C data, since it is
/// reached through dlsym: `struct FakeHd* fake_hd(void)`; `void fake_hd_by_hand(bool)` takes the scheduler's thread
/// away, and `void fake_hd_call(void)` is then one of its rounds. In a file that processes share where $PALPATE_FAKE_HD
/// names one.

struct FakeHd {
  int present = 1;
  // One call fails at a time: each call of this name puts the error on the stack, after so many that succeed.
  unsigned error = 0;
  char failing_call[32] = "hdEndFrame";
  int sound_calls = 0;
  unsigned at_init[4] = {};        // put on the stack by hdInitDevice, the last on top; 0: none
  int styles = 4;                  // of calibration: encoder reset 1, automatic 2, inkwell 4
  unsigned calibration = 0x5000;   // what hdCheckCalibration says
  unsigned after_update = 0x5000;  // and after hdUpdateCalibration
  double place_mm[3] = {0, 0, 0};
  double transform[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};  // column by column
  double force[3] = {0, 0, 0};
  int buttons = 0;
  int stalled = 0;  // the scheduler calls nobody
  int enabled = 0;  // bits: forces 1, clamping 2, ramping 4
  int in_frame = 0;
  int misuses = 0;  // calls outside a frame, or in an order that the real one does not bear
  int running = 0;
  int disabled = 0;
  int callbacks = 0;
  char named[64] = {};
  int unplugged = 0;  // no force arrives any more, and the library tells of it
  int torques = 0;    // anything set but a force
  int scheduled = 0;  // callbacks that are still scheduled
  // What it says of itself.
  double force_newtons = 3.3, continuous_newtons = 0.88, stiffness_newtons_per_mm = 0.5;
  double box_mm[6] = {-80, -60, -35, 80, 60, 35};  // lowest x, y, z, highest x, y, z
  char model[64] = "PHANToM Omni";                 // empty: it does not say
  // What it was told.
  unsigned long rate_hz = 0;
  int priority = -1;
  unsigned made_current = 0, style = 0;
  int updates = 0;          // of the calibration
  double update_force = 0;  // N, that acted while it was updated last
};
