# What tegotae::io needs: libraries of file formats.
find_package(assimp 5.2 REQUIRED)
find_package(draco REQUIRED)  # with meshoptimizer: compressed glTF
find_package(meshoptimizer REQUIRED)
find_package(pugixml REQUIRED)  # with minizip: 3MF
find_library(TEGOTAE_MINIZIP minizip REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(ZLIB REQUIRED)
find_package(zstd REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
option(TEGOTAE_STEP "Read STEP files, where OpenCASCADE is installed" ON)
if(TEGOTAE_STEP)
  find_package(OpenCASCADE QUIET)  # without a version: the package's check of it is for equality
endif()
if(OpenCASCADE_FOUND)
  set(TEGOTAE_READS_STEP ON)
else()
  message(STATUS "OpenCASCADE not found or not wanted: no STEP files")
endif()
# OpenCASCADE 7.8 put the toolkits of STEP into one.
if(TARGET TKDESTEP)
  set(TEGOTAE_STEP_TOOLKITS TKDESTEP)
else()
  set(TEGOTAE_STEP_TOOLKITS TKXDESTEP TKSTEP TKSTEPBase TKSTEPAttr)
endif()
list(APPEND TEGOTAE_STEP_TOOLKITS TKXSBase TKXCAF TKLCAF TKCDF TKMesh TKTopAlgo TKBRep TKGeomBase TKG3d TKG2d TKMath
                                  TKernel)

set(TEGOTAE_IO_LIBRARIES assimp::assimp draco::draco pugixml::pugixml ${TEGOTAE_MINIZIP} tomlplusplus::tomlplusplus ZLIB::ZLIB
                         zstd::libzstd_shared)
# The file, not the target: that has a definition for every source.
list(APPEND TEGOTAE_IO_LIBRARIES $<TARGET_FILE:meshoptimizer::meshoptimizer>)
if(TEGOTAE_READS_STEP)
  # The files, not the targets: those ask for the development packages of TBB, FreeImage and FreeType too.
  foreach(toolkit ${TEGOTAE_STEP_TOOLKITS})
    list(APPEND TEGOTAE_IO_LIBRARIES $<TARGET_FILE:${toolkit}>)
  endforeach()
endif()
