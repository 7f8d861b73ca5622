// What the drivers say of devices that are there and cannot be had: palpate on umockdev's devices, which nobody answers
// for.

#include <unistd.h>

#include <string>
#include <vector>

#include "plugin/messages/provoked.h"
#include "plugin/messages/provoked_scans.h"
#include "plugin/testing/command_rig.h"
#include "testdata/sanitized.h"

namespace palpate::plugin::testing {
namespace {

/// A Falcon on the first bus, by its number there.
std::string falcon(int number, bool with_node = true) {
  const std::string at = "bus/usb/001/00" + std::to_string(number);
  return "P: /devices/usb1/1-" + std::to_string(number) + "\n" + (with_node ? "N: " + at + "\n" : "") +
         "E: SUBSYSTEM=usb\nE: DRIVER=usb\nE: BUSNUM=001\nE: DEVNUM=00" + std::to_string(number) +
         "\nE: DEVNAME=/dev/" + at +
         "\nE: DEVTYPE=usb_device\nA: bConfigurationValue=1\\n\nA: busnum=1\\n\nA: devnum=" + std::to_string(number) +
         "\\n\nA: speed=12\\n\nH: descriptors=1201000200000040030448cb00050102030109022000010100802d0904000002ffffff00"
         "0705810240000007050202400000\n\n";
}

/// A SpaceMouse with its HID node.
std::string space_mouse() {
  const std::string usb = "/devices/usb1/1-2";
  const std::string name = "0003:046D:C626.0001";
  const std::string hid = usb + "/1-2:1.0/" + name;
  return "P: " + usb +
         "\nN: bus/usb/001/003\nE: DEVNAME=/dev/bus/usb/001/003\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nE: "
         "BUSNUM=001\nE: DEVNUM=003\nA: idVendor=046d\\n\nA: idProduct=c626\\n\nA: busnum=1\\n\nA: devnum=3\\n\n\n"
         "P: " +
         usb + "/1-2:1.0\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_interface\nA: bInterfaceNumber=00\\n\n\nP: " + hid +
         "\nE: SUBSYSTEM=hid\nE: HID_ID=0003:0000046D:0000C626\nE: HID_NAME=mouse\nE: HID_UNIQ=1\nE: HID_PHYS=fake\n"
         "H: report_descriptor=05010908a10116a2fe265e017510950385010930093109328102c0\n\nP: " +
         hid + "/hidraw/hidraw0\nN: hidraw0=00\nE: SUBSYSTEM=hidraw\nL: device=../../../" + name +
         "\nE: DEVNAME=/dev/hidraw0\nE: MAJOR=246\nE: MINOR=0\n\n";
}

/// What a probe with such a stylus says where these devices are; `before` is done there first.
std::string of(const std::string& record, const std::string& kind, const std::string& before = "") {
  const std::string file = fresh_path("record.umockdev").string();
  write_bytes(file, record);
  const std::string probe = std::string(PALPATE_PROGRAM) + " probe " + phantom().string() +
                            " --scene ct-skin-and-bone --device " + kind + " -o " + fresh_path("usb").string();
  return output_of("umockdev-run -d " + file + " -- sh -c '" + before + " " + probe + "'");
}

}  // namespace

std::vector<Provoked> provoke_usb() {
  // Root may read all, unless it has given that up.
  const std::string as_any_user = ::geteuid() == 0 ? "setpriv --bounding-set=-dac_override,-dac_read_search" : "";
  const std::string locked = of(falcon(2), "falcon", "chmod 0 $UMOCKDEV_DIR/dev/bus/usb/001/002; " + as_any_user);
  return {
      {"{}: there are {}; name the address of one, as `palpate devices` lists them",
       of(falcon(2) + falcon(3), "falcon")},
      {"{}: cannot be opened: {}; unplug it and plug it in again", of(falcon(2, false), "falcon")},
      {"Novint Falcon: another program holds it ({}); close that one first", of(falcon(2), "falcon")},
      {"{}: permission denied; {}", locked},
      {"type: sudo cp {} /etc/udev/rules.d/ && sudo udevadm control --reload && sudo udevadm trigger && sudo adduser "
       "$USER plugdev; then log in again and replug the device",
       locked},
      {"{}: cannot be opened: {}; does another program hold it?", of(space_mouse(), "space_mouse")},
  };
}

namespace {

bool is_of_usb(const std::string& message) {
  return message.find("permission denied") != std::string::npos || message.starts_with("type: sudo cp") ||
         message.find("another program hold") != std::string::npos ||
         message.find("there are {}; name") != std::string::npos ||
         message.find("cannot be opened: {}; unplug") != std::string::npos;
}

}  // namespace

bool can_provoke_usb() {
  return !testdata::is_sanitized && output_of("umockdev-run --version").find("not found") == std::string::npos;
}

bool cannot_be_had_here(const std::string& message) {
  return (is_of_usb(message) && !can_provoke_usb()) ||
         (testdata::is_sanitized && message.find("needs more memory than there is") != std::string::npos);
}

}  // namespace palpate::plugin::testing
