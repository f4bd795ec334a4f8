# Read by CPack before it packs.

if(CPACK_PACKAGE_CONTACT MATCHES "@localhost")
  message(WARNING "The package names no maintainer that can be reached: "
    "${CPACK_PACKAGE_CONTACT}. Before it is handed on, configure with "
    "-DLIMBER_MAINTAINER=\"Your Name <you@your.site>\".")
endif()
