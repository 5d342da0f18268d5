# The program for other machines, in build/package: a Debian package, and an archive that runs where it is unpacked.
.PHONY: package

package: all
	@PACKAGE=yes sh $(support)/setup.sh
	$(stage) kind=release $(portable)
	@sh make/package.sh $(program) $(portable) build/package
