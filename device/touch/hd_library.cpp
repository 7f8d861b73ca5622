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

}  // namespace palpate::device
