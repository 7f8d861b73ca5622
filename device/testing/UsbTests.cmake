# The drivers through the real libusb and hidapi, in a session of its own, against the fakes behind libumockdev. Each test
# ends well only when the last force that the fake saw is zero. Both sides are real-time processes where that is allowed,
# so that a busy machine makes none of them late.
add_executable(device_client testing/client_main.cpp)
target_link_libraries(device_client PRIVATE palpate::device palpate_compile_options)
add_dependencies(device_client palpate_guardian)

# The same in a virtual machine with the kernel's own USB and HID stack: device/testing/guest/boot runs it there.
add_executable(device_guest testing/guest_main.cpp testing/fake_usb.cpp testing/usbip_mount.cpp
  testing/uhid_mount.cpp)
target_link_libraries(device_guest PRIVATE palpate_fake_devices palpate_compile_options)

pkg_check_modules(umockdev umockdev-1.0)
find_program(UMOCKDEV_WRAPPER umockdev-wrapper)
if(PALPATE_SANITIZE)
  set(why_not "sanitizers and umockdev's preloaded library do not go together")
elseif(NOT umockdev_FOUND OR NOT UMOCKDEV_WRAPPER)
  set(why_not "umockdev is not installed: apt-get install umockdev libumockdev-dev")
else()
  set(why_not "")
  add_executable(device_umockdev testing/umockdev_main.cpp testing/umockdev_falcon.cpp
    testing/umockdev_hid.cpp)
  target_include_directories(device_umockdev SYSTEM PRIVATE ${umockdev_INCLUDE_DIRS})
  target_link_libraries(device_umockdev PRIVATE palpate_fake_devices palpate_compile_options
    ${umockdev_LINK_LIBRARIES})
endif()

foreach(case falcon:run falcon:unplug falcon:sigint falcon:sigterm falcon:sigkill wooden_haptics:run wooden_haptics:unplug
    wooden_haptics:sigkill space_mouse:run space_mouse:unplug)
  string(REPLACE ":" ";" words ${case})
  set(test device.usb.${case})
  if(why_not)
    add_test(NAME ${test} COMMAND ${CMAKE_COMMAND} -E echo "skipped: ${why_not}")
    set_tests_properties(${test} PROPERTIES SKIP_REGULAR_EXPRESSION "skipped:")
  else()
    add_test(NAME ${test} COMMAND ${UMOCKDEV_WRAPPER} $<TARGET_FILE:device_umockdev> $<TARGET_FILE:device_client> ${words})
    # Several at once would starve each other of the time that a silent device is told by.
    set_tests_properties(${test} PROPERTIES TIMEOUT 20 RUN_SERIAL TRUE LABELS usb)
  endif()
endforeach()
