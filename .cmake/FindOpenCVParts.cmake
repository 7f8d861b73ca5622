# OpenCV's core, imgproc and photo alone. Debian's OpenCVConfig.cmake comes only with libopencv-dev, which also brings viz and with
# it a second VTK; one process must not hold both that and ParaView's. Defines OpenCVParts::core, OpenCVParts::imgproc
# and OpenCVParts::photo.
find_path(OpenCVParts_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4)
foreach(part core imgproc photo)
  find_library(OpenCVParts_${part}_LIBRARY opencv_${part})
endforeach()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenCVParts
  REQUIRED_VARS OpenCVParts_core_LIBRARY OpenCVParts_imgproc_LIBRARY OpenCVParts_photo_LIBRARY OpenCVParts_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "install libopencv-core-dev, libopencv-imgproc-dev and libopencv-photo-dev")
foreach(part core imgproc photo)
  if(OpenCVParts_FOUND AND NOT TARGET OpenCVParts::${part})
    add_library(OpenCVParts::${part} UNKNOWN IMPORTED)
    set_target_properties(OpenCVParts::${part} PROPERTIES IMPORTED_LOCATION ${OpenCVParts_${part}_LIBRARY}
      INTERFACE_INCLUDE_DIRECTORIES ${OpenCVParts_INCLUDE_DIR})
  endif()
endforeach()
