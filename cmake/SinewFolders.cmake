# How a folder of src/ becomes part of a library.
#
# sn_folder(NAME CORE|FULL [KERNELS subfolder] [LIBRARIES targets…])
#   every .c of src/NAME (subfolders included) becomes an OBJECT library. Files of the KERNELS
#   subfolder are compiled once for every instruction set and precision, with
#     SN_ISA=scalar|sse2|avx2|avx512|neon   SN_LANE_BYTES=0|16|32|64   SN_REAL_BITS=32|64
#   (base/wide.h reads them); the processor chooses a row at run time (base/isa.c).

if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(SINEW_ISAS scalar sse2 avx2 avx512)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
  set(SINEW_ISAS scalar neon)
else()
  set(SINEW_ISAS scalar)
endif()
if(SINEW_FUZZ)
  set(SINEW_ISAS scalar) # readers run no kernels
endif()
set(SN_FLAGS_scalar "")
set(SN_FLAGS_sse2 -msse2)
set(SN_FLAGS_neon "")
set(SN_FLAGS_avx2 -mavx2)
set(SN_FLAGS_avx512 -mavx512f -mavx512dq -mavx512vl -mprefer-vector-width=512)
set(SN_BYTES_scalar 0)
set(SN_BYTES_sse2 16)
set(SN_BYTES_neon 16)
set(SN_BYTES_avx2 32)
set(SN_BYTES_avx512 64)
foreach(isa ${SINEW_ISAS})
  list(APPEND SN_ISA_DEFINITIONS SN_HAVE_ISA_${isa}=1)
endforeach()

function(sn_object_library target libraries)
  add_library(${target} OBJECT ${ARGN})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/include
                                               ${PROJECT_SOURCE_DIR}/src)
  target_compile_definitions(${target} PRIVATE ${SN_ISA_DEFINITIONS})
  target_link_libraries(${target} PRIVATE ${libraries})
endfunction()

function(sn_folder name level)
  cmake_parse_arguments(ARG "" "KERNELS" "LIBRARIES" ${ARGN})
  set(root ${PROJECT_SOURCE_DIR}/src/${name})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${root}/*.c)
  set(objects)
  if(ARG_KERNELS)
    file(GLOB kernels CONFIGURE_DEPENDS ${root}/${ARG_KERNELS}/*.c)
    list(REMOVE_ITEM sources ${kernels} "")
    set(isas ${SINEW_ISAS})
    if(NOT kernels)
      set(isas)
    endif()
    foreach(isa ${isas})
      foreach(bits 32 64)
        set(target ${name}_${isa}_${bits})
        sn_object_library(${target} "" ${kernels})
        target_compile_definitions(${target} PRIVATE SN_ISA=${isa} SN_REAL_BITS=${bits}
                                                     SN_LANE_BYTES=${SN_BYTES_${isa}})
        # -Wpsabi: wide types cross only static inline functions
        target_compile_options(${target} PRIVATE ${SN_FLAGS_${isa}} -Wno-psabi)
        if(SINEW_FUZZ)
          target_compile_options(${target} PRIVATE -fno-sanitize=all -O0) # minutes else
        endif()
        list(APPEND objects ${target})
      endforeach()
    endforeach()
  endif()
  if(sources)
    sn_object_library(${name} "${ARG_LIBRARIES}" ${sources})
    list(APPEND objects ${name})
  endif()
  set_property(GLOBAL APPEND PROPERTY SN_OBJECTS_${level} ${objects})
  set_property(GLOBAL APPEND PROPERTY SN_LIBRARIES_${level} ${ARG_LIBRARIES})
endfunction()

# libsinew (shared and static): what a simulator embeds; libm only. libsinew-full: the rest.
# sn_core_objects and sn_full_objects hand the objects to tests, which see hidden symbols.
function(sn_libraries)
  get_property(core GLOBAL PROPERTY SN_OBJECTS_CORE)
  get_property(full GLOBAL PROPERTY SN_OBJECTS_FULL)
  get_property(libraries GLOBAL PROPERTY SN_LIBRARIES_FULL)
  set(core_objects)
  foreach(object ${core})
    list(APPEND core_objects $<TARGET_OBJECTS:${object}>)
  endforeach()
  set(full_objects)
  foreach(object ${full})
    list(APPEND full_objects $<TARGET_OBJECTS:${object}>)
  endforeach()

  add_library(sinew SHARED ${core_objects})
  add_library(sinew_static STATIC ${core_objects})
  set_target_properties(sinew_static PROPERTIES OUTPUT_NAME sinew)
  add_library(sinew-full SHARED ${full_objects})
  target_link_libraries(sinew-full PUBLIC sinew PRIVATE ${libraries})
  foreach(library sinew sinew_static sinew-full)
    target_include_directories(${library} INTERFACE
      $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    set_target_properties(${library} PROPERTIES LINKER_LANGUAGE C VERSION ${PROJECT_VERSION}
                                                SOVERSION ${PROJECT_VERSION_MAJOR})
    target_link_libraries(${library} PUBLIC m)
  endforeach()

  add_library(sn_core_objects INTERFACE)
  target_sources(sn_core_objects INTERFACE ${core_objects})
  target_link_libraries(sn_core_objects INTERFACE m)
  add_library(sn_full_objects INTERFACE)
  target_sources(sn_full_objects INTERFACE ${full_objects})
  target_link_libraries(sn_full_objects INTERFACE sn_core_objects ${libraries})
endfunction()

function(sn_command folder)
  cmake_parse_arguments(ARG "" "" "LIBRARIES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${folder}/*.c)
  if(NOT sources)
    return()
  endif()
  add_executable(sinew_command ${sources})
  set_target_properties(sinew_command PROPERTIES OUTPUT_NAME sinew
                        INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  target_include_directories(sinew_command PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(sinew_command PRIVATE sinew-full sinew ${ARG_LIBRARIES})
  install(TARGETS sinew_command RUNTIME)
endfunction()

function(sn_install)
  include(CMakePackageConfigHelpers)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/sinew DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(TARGETS sinew sinew_static sinew-full EXPORT sinewTargets)
  install(EXPORT sinewTargets NAMESPACE sinew:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sinew)
  configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/sinewConfig.cmake.in
    ${PROJECT_BINARY_DIR}/sinewConfig.cmake
    INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sinew)
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/sinewConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/sinewConfig.cmake
                ${PROJECT_BINARY_DIR}/sinewConfigVersion.cmake
          DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sinew)
  file(RELATIVE_PATH SINEW_PC_TO_PREFIX /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/sinew.pc.in ${PROJECT_BINARY_DIR}/sinew.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/sinew.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
