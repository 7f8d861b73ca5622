#include "device/touch/hd_library.h"

#include <string>
#include <vector>

namespace palpate::device {

namespace {

constexpr const char* advice =
    "install OpenHaptics 3.4 developer edition and the Touch device driver (3dsystems.com), set the device up with its "
    "Touch_Setup, or name libHD.so in PALPATE_LIBHD";

std::vector<std::string> files() {
  return library_candidates("PALPATE_LIBHD",
                            {"libHD.so.3.4", "libHD.so.3.0", "libHD.so", "/usr/lib/libHD.so", "/usr/local/lib/libHD.so",
                             "/opt/OpenHaptics/Developer/3.4-0/lib/libHD.so"});
}

}  // namespace

HdLibrary::HdLibrary() : library("3D Systems Touch", files(), advice) {
  library.find("hdInitDevice", init_device);
  library.find("hdDisableDevice", disable_device);
  library.find("hdMakeCurrentDevice", make_current_device);
  library.find("hdBeginFrame", begin_frame);
  library.find("hdEndFrame", end_frame);
  library.find("hdGetError", get_error);
  library.find("hdGetErrorString", get_error_string);
  library.find("hdEnable", enable);
  library.find("hdGetDoublev", get_doubles);
  library.find("hdGetIntegerv", get_integers);
  library.find("hdGetString", get_string);
  library.find("hdSetDoublev", set_doubles);
  library.find("hdCheckCalibration", check_calibration);
  library.find("hdUpdateCalibration", update_calibration);
  library.find("hdStartScheduler", start_scheduler);
  library.find("hdStopScheduler", stop_scheduler);
  library.find("hdSetSchedulerRate", set_scheduler_rate);
  library.find("hdScheduleAsynchronous", schedule_asynchronous);
  library.find("hdUnschedule", unschedule);
}

hd::Severity hd::severity_of(unsigned code) noexcept {
  if (code == success) return Severity::none;
  if (code == exceeded_force || code == force_impulse) return Severity::force_clamped;
  return (code & ~0xffU) == warm_motors ? Severity::force_taken_away : Severity::device_failed;
}

unsigned HdLibrary::drain_errors() const noexcept {
  constexpr int most = 256;  // a stack that fills faster than it is emptied must not hold the caller
  unsigned gravest = hd::success;
  for (int i = 0; i < most; ++i) {
    const unsigned code = get_error().code;
    if (code == hd::success) break;
    if (hd::severity_of(code) > hd::severity_of(gravest)) gravest = code;
  }
  return gravest;
}

std::string HdLibrary::words_for(unsigned code) const {
  const char* const text = get_error_string(code);
  return text != nullptr ? text : std::to_string(code);
}

unsigned HdLibrary::open_device(const std::string& name, unsigned& error) const noexcept {
  drain_errors();  // those of an earlier device are not this one's
  const unsigned device = init_device(name.empty() ? nullptr : name.c_str());
  error = drain_errors();
  const bool has_failed = hd::severity_of(error) == hd::Severity::device_failed;
  if (device != hd::invalid_device && has_failed) disable_device(device);
  return has_failed ? hd::invalid_device : device;
}

}  // namespace palpate::device
