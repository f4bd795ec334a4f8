# What `cmake --install` puts where, and the Debian package that CPack makes of it:
#
#   cmake --install build/release --prefix /usr/local
#   cd build/release && cpack
#
# The program finds share/limber/plot beside its own folder, so the prefix may be
# moved as a whole. For a package configure with -DLIMBER_NATIVE=OFF, so that it runs
# on other processors.

include(GNUInstallDirs)

# deal.II's libraries may lie in folders that the system does not search.
set_target_properties(limber PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
install(TARGETS limber RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY contrib/plot/ DESTINATION ${CMAKE_INSTALL_DATADIR}/limber/plot
  FILES_MATCHING PATTERN "*.py" PATTERN "__pycache__" EXCLUDE)
install(DIRECTORY prm/ DESTINATION ${CMAKE_INSTALL_DATADIR}/limber/prm
  FILES_MATCHING PATTERN "*.prm" PATTERN "README.md"
  PATTERN "*.stl" PATTERN "*.pgm" PATTERN "*.png" PATTERN "*.msh")
install(FILES contrib/packaging/limber.1
  DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES contrib/packaging/completion.bash RENAME limber
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES README.md CHANGELOG.md CONTRIBUTING.md CITATION.cff LICENSE
  DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES LICENSE RENAME copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY doc/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/doc)

# Pages and scenes find each other as in the sources.
file(RELATIVE_PATH scenes ${CMAKE_INSTALL_FULL_DOCDIR}
  ${CMAKE_INSTALL_FULL_DATADIR}/limber/prm)
file(RELATIVE_PATH pages ${CMAKE_INSTALL_FULL_DATADIR}/limber
  ${CMAKE_INSTALL_FULL_DOCDIR}/doc)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/links)
file(CREATE_LINK ${scenes} ${PROJECT_BINARY_DIR}/links/prm SYMBOLIC)
file(CREATE_LINK ${pages} ${PROJECT_BINARY_DIR}/links/doc SYMBOLIC)
install(FILES ${PROJECT_BINARY_DIR}/links/prm DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${PROJECT_BINARY_DIR}/links/doc
  DESTINATION ${CMAKE_INSTALL_DATADIR}/limber)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME limber)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
# Mail goes to the administrator of the machine: whoever hands a package on names a
# person instead.
set(LIMBER_MAINTAINER "Limber developers <root@localhost>" CACHE STRING
  "Name and address in the Debian package")
set(CPACK_PACKAGE_CONTACT "${LIMBER_MAINTAINER}")
set(CPACK_PROJECT_CONFIG_FILE
  ${CMAKE_CURRENT_SOURCE_DIR}/contrib/packaging/check_maintainer.cmake)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY
  "material point method for solids and fluids that do not lock")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
  "Material points on a background grid, explicit, semi-implicit or implicit in
time, in two and three dimensions, parallel by MPI. Commands run scenes, compare
them with finite elements, and draw pictures and films. Scenes and documents
come along.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES YES)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS YES)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "openmpi-bin")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS
  "python3-numpy, python3-matplotlib, python3-h5py")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "ffmpeg")
include(CPack)
