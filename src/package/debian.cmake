# `cpack -G DEB` in the build folder: libtegotae-dev, tegotae (programs), and libtegotaeVERSION of a shared build.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "Tegotae")
set(CPACK_PACKAGE_CONTACT "Tegotae <tegotae@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)

set(abi ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libtegotae${abi})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libtegotae-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
if(BUILD_SHARED_LIBS)
  set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libtegotae${abi} (= ${PROJECT_VERSION}), libeigen3-dev")
else()
  set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
      "libeigen3-dev, libfcl-dev, libccd-dev, libassimp-dev, libdraco-dev, libmeshoptimizer-dev, libpugixml-dev, libminizip-dev, libtomlplusplus-dev, \
zlib1g-dev, libzstd-dev")
  if(TEGOTAE_READS_STEP)
    string(APPEND CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS ", libocct-data-exchange-dev")
  endif()
  set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "libspnav-dev, libsdl2-dev")  # the component backends
endif()

set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME tegotae)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
include(CPack)
