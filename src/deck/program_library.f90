!> The files that come with the program: `library/NAME` on an INCLUDE card.
module program_library
  use file_system, only: file_exists, real_path
  implicit none (type, external)
  private

  public :: find_library_file

  !> Beginning of the names on INCLUDE cards that are looked for in the program's library too.
  character(len=*), parameter :: prefix = "library/"

  !> Where the library is, from the folder of the program: installed, or in its checkout.
  character(len=*), parameter :: installed = "/../share/flexmech/", checkout = "/../../"

contains

  !> Finds a file of the library, if its name begins with `library/` and nothing is at its own path:
  !! the file of the user goes before that of the program.
  subroutine find_library_file(name, path, library_name, elsewhere)
    character(len=*), intent(in) :: name                 !! on the INCLUDE card
    character(len=:), allocatable, intent(inout) :: path !! of the file from the working folder; on
                                                         !! return, of that in the library
    character(len=:), allocatable, intent(out) :: library_name !! `name` of a file in the library;
                                                               !! empty: `path` is unchanged
    character(len=:), allocatable, intent(out) :: elsewhere !! where it was looked for, to follow
                                                            !! `no such file`; empty for other names

    character(len=:), allocatable :: program_file, folder, found

    library_name = ""
    elsewhere = ""
    if (index(name, prefix) /= 1) return
    if (file_exists(path)) return
    program_file = real_path("/proc/self/exe")
    folder = program_file(:max(0, index(program_file, "/", back=.true.) - 1))
    found = real_path(folder//installed//name)
    if (len(found) == 0) found = real_path(folder//checkout//name)
    if (len(found) > 0) then
      path = found
      library_name = name
      return
    end if
    elsewhere = " in '"//path(:max(0, len(path) - len(name) - 1))//"'"
    if (len(path) == len(name)) elsewhere = " here"
    found = real_path(folder//installed//prefix)
    if (len(found) == 0) found = real_path(folder//checkout//prefix)
    if (len(found) == 0) then
      elsewhere = elsewhere//", and this program has no library"
    else
      elsewhere = elsewhere//", nor in '"//found//"'"
    end if
  end subroutine find_library_file

end module program_library
