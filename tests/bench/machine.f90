!> The machine that times were taken on, in words.
module machine
  use, intrinsic :: iso_fortran_env, only: compiler_version
  use omp_lib, only: omp_get_num_procs
  use text, only: string_t, to_string
  implicit none (type, external)
  private

  public :: machine_notes

contains

  !> Processor, compiler and libraries, a line each.
  function machine_notes(libraries) result(notes)
    character(len=*), intent(in) :: libraries !! the BLAS that was linked, as in `make BLAS=`
    type(string_t), allocatable :: notes(:)

    allocate (notes(2))
    notes(1)%text = "machine: "//processor_model()//", "//to_string(omp_get_num_procs())//" processors"
    notes(2)%text = "compiler: "//compiler_version()//"; LAPACK and BLAS: "//libraries
  end function machine_notes

  !> As the system tells it.
  function processor_model() result(model)
    character(len=:), allocatable :: model

    character(len=200) :: line
    integer :: unit, status

    model = "a processor without a name"
    open (newunit=unit, file="/proc/cpuinfo", status="old", action="read", iostat=status)
    if (status /= 0) return
    do
      read (unit, "(a)", iostat=status) line
      if (status /= 0) exit
      if (index(line, "model name") /= 1) cycle
      model = trim(adjustl(line(index(line, ":") + 1:)))
      exit
    end do
    close (unit)
  end function processor_model

end module machine
