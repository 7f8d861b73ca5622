# What device/testing/guest/boot runs in a virtual machine: an unmodified client, with the real libusb and hidapi, and the
# fakes, which are plugged into the kernel's own USB and HID stack.
add_executable(device_client testing/client_main.cpp)
target_link_libraries(device_client PRIVATE palpate::device palpate_compile_options)
add_dependencies(device_client palpate_guardian)

add_executable(device_guest testing/guest_main.cpp testing/fake_usb.cpp testing/usbip_mount.cpp
  testing/uhid_mount.cpp)
target_link_libraries(device_guest PRIVATE palpate_fake_devices palpate_compile_options)
