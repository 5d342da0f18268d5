!> Name and version of the program.
module program_version
  implicit none (type, external)
  private

  public :: program_name, version_number

  character(len=*), parameter :: program_name = "flexmech", version_number = "0.3.0"

end module program_version
