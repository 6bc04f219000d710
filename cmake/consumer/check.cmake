# cmake -D BUILD=... -D COMPONENTS=core,io -D COMPILER=... -P check.cmake: installs these components and nothing else
# into a prefix of their own, then builds and runs the project beside this file against it.
cmake_minimum_required(VERSION 3.25)
string(REPLACE "," ";" COMPONENTS ${COMPONENTS})
list(JOIN COMPONENTS "_" name)
set(root ${BUILD}/consumer/${name})
file(REMOVE_RECURSE ${root})

function(run)
    execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

foreach(component IN LISTS COMPONENTS)
    run(${CMAKE_COMMAND} --install ${BUILD} --component ${component} --prefix ${root}/prefix)
endforeach()

# What a component does not need must not even be looked for.
set(hidden CLI11 nlohmann_json)
if(NOT "design" IN_LIST COMPONENTS)
    list(APPEND hidden Ceres Eigen3)
endif()
if(NOT "io" IN_LIST COMPONENTS)
    list(APPEND hidden OpenImageIO fmt)
endif()
list(TRANSFORM hidden REPLACE "(.+)" "-DCMAKE_DISABLE_FIND_PACKAGE_\\1=ON")

run(${CMAKE_COMMAND} --no-warn-unused-cli -G Ninja -S ${CMAKE_CURRENT_LIST_DIR} -B ${root}/build ${hidden} "-DCOMPONENTS=${COMPONENTS}"
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${root}/prefix)
run(${CMAKE_COMMAND} --build ${root}/build)
run(${root}/build/consumer)
