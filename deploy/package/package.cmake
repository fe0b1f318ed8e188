# SPDX-License-Identifier: Apache-2.0
# Builds the Debian package: `cmake --workflow --preset package` writes the package to
# build/release. The package contains the programs that serve and scan, but not the simulated
# scanner.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # packs the existing build without building again
set(here ${CMAKE_CURRENT_LIST_DIR})
set(documents /usr/share/doc/vitrine)

install(TARGETS vitrine vitrined vitrine-guardian RUNTIME DESTINATION /usr/bin)
install(FILES deploy/vitrined.service DESTINATION /lib/systemd/system)
install(FILES deploy/60-vitrine.rules DESTINATION /lib/udev/rules.d)
install(FILES ${here}/sysusers DESTINATION /usr/lib/sysusers.d RENAME vitrine.conf)
install(FILES ${here}/tmpfiles DESTINATION /usr/lib/tmpfiles.d RENAME vitrine.conf)
install(FILES ${here}/completion DESTINATION /usr/share/bash-completion/completions RENAME vitrine)
install(FILES ${here}/logrotate DESTINATION /etc/logrotate.d RENAME vitrine)
install(FILES ${here}/copyright LICENSE NOTICE README.md DESTINATION ${documents})
foreach(part acquisition codec server web)
  install(FILES ${part}/README.md DESTINATION ${documents}/${part})
endforeach()
install(DIRECTORY deploy/nginx deploy/monitoring DESTINATION ${documents}/examples)
install(CODE "set(bin \"${CMAKE_RUNTIME_OUTPUT_DIRECTORY}\")\nset(source \"${CMAKE_SOURCE_DIR}\")")
install(SCRIPT ${here}/generated.cmake)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME vitrine)
set(CPACK_PACKAGE_CONTACT "The Vitrine authors <vitrine@museum.example>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "server of scanned objects as progressive meshes")
set(CPACK_PACKAGE_DESCRIPTION "Visitors see the whole object after one request, and then watch it sharpen down
to the last triangle of the scan. With the programs that build, verify and
publish such models, and that scan objects with a laser and a turntable.")
set(CPACK_STRIP_FILES ON)
set(CPACK_SET_DESTDIR ON)
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION web)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "systemd | systemd-standalone-sysusers, systemd | systemd-standalone-tmpfiles")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "logrotate, udev")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS nginx)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${here}/conffiles ${here}/postinst ${here}/prerm ${here}/postrm)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)
