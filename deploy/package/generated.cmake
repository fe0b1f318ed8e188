# SPDX-License-Identifier: Apache-2.0
# Generates the configuration file from --print-config and the manual pages from --help.
set(root "$ENV{DESTDIR}")

# Defaults are commented out, so that a later version can change them.
execute_process(COMMAND env -i ${bin}/vitrined --data=/var/lib/vitrine --access-log=/var/log/vitrine/access.log --print-config
                OUTPUT_VARIABLE settings COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "; from default([^\n]*)\n" "\\1\n#" settings "${settings}")
string(REGEX REPLACE "; from --[^;\n]*" "" settings "${settings}")
file(WRITE ${root}/etc/vitrine.conf "# Settings of vitrined; `systemctl reload vitrined` reads them again.\n\n${settings}")

function(manual_page program section name)
  set(page ${root}/usr/share/man/man${section}/${program}.${section})
  execute_process(COMMAND help2man --no-info --section=${section} "--name=${name}" ${bin}/${program}
                  OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  file(WRITE ${page} "${text}")
  execute_process(COMMAND gzip -9n ${page} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
manual_page(vitrine 1 "builds, checks, publishes and scans progressive meshes")
manual_page(vitrined 8 "serves progressive meshes over HTTP and WebSocket")

set(news ${root}/usr/share/doc/vitrine/changelog)
configure_file(${source}/CHANGELOG.md ${news} COPYONLY)
execute_process(COMMAND gzip -9n ${news} COMMAND_ERROR_IS_FATAL ANY)
