# An overlay port: vcpkg install hbvib --overlay-ports=packaging/vcpkg, in a checkout. Cargo has to be on the path.
set(VCPKG_POLICY_DLLS_WITHOUT_EXPORTS enabled)
set(VCPKG_POLICY_MISMATCHED_NUMBER_OF_BINARIES enabled)
get_filename_component(SOURCE_PATH "${CURRENT_PORT_DIR}/../../.." ABSOLUTE)
find_program(CARGO cargo REQUIRED)
vcpkg_execute_required_process(
    COMMAND "${CMAKE_COMMAND}" -E env "CARGO=${CARGO}" "CARGO_TARGET_DIR=${CURRENT_BUILDTREES_DIR}/target"
            sh "${SOURCE_PATH}/examples/install.sh" "${CURRENT_PACKAGES_DIR}"
    WORKING_DIRECTORY "${SOURCE_PATH}"
    LOGNAME "install-${TARGET_TRIPLET}")
file(RENAME "${CURRENT_PACKAGES_DIR}/lib/cmake/hbvib" "${CURRENT_PACKAGES_DIR}/share/hbvib-cmake")
file(GLOB configs "${CURRENT_PACKAGES_DIR}/share/hbvib-cmake/*.cmake")
file(COPY ${configs} DESTINATION "${CURRENT_PACKAGES_DIR}/share/hbvib")
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/share/hbvib-cmake" "${CURRENT_PACKAGES_DIR}/lib/cmake")
# From share/hbvib the prefix is two folders up, from lib/cmake/hbvib three.
vcpkg_replace_string("${CURRENT_PACKAGES_DIR}/share/hbvib/hbvib-config.cmake" "/../../.." "/../..")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE-MIT" "${SOURCE_PATH}/LICENSE-APACHE")
