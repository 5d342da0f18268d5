!> Records what each variant of a deck takes: the rank that computes it, the bytes that it sends, and
!! the leader, which restores and writes them.
!!
!!     record_tasks DECK FOLDER RECORD
program record_tasks
  use, intrinsic :: iso_fortran_env, only: error_unit
  use deck_outputs, only: discard_outputs, open_outputs, outputs_t
  use deck_readings, only: deck_t, read_deck
  use errors, only: error_t, rendered
  use kinds, only: wp
  use recorded_jobs, only: recorded_job_t
  use tables, only: column_t, real_column
  use task_journal, only: journal_t
  use tasks, only: run_tasks
  use text, only: string_t
  use variant_tasks, only: begin_variant_job, variant_job_t
  use variants, only: parameter_names, variant_count
  implicit none (type, external)

  character(len=1024) :: path, folder, record
  type(deck_t), target :: deck
  type(outputs_t), target :: outputs
  type(variant_job_t), target :: job
  type(recorded_job_t) :: recorded
  type(journal_t) :: no_journal
  type(string_t) :: no_inputs(0) !! nothing to be kept from being written over: the folder is scratch
  type(column_t), allocatable :: parameters(:)
  type(error_t), allocatable :: error
  integer :: unit, count, i

  call get_command_argument(1, path)
  call get_command_argument(2, folder)
  call get_command_argument(3, record)
  call read_deck(trim(path), 1, deck)
  if (len(deck%errors) > 0) then
    write (error_unit, "(a)", advance="no") deck%errors
    stop 2, quiet=.true.
  end if
  count = variant_count(deck%cards)
  allocate (parameters(size(parameter_names(deck%cards))))
  do i = 1, size(parameters)
    parameters(i) = real_column(deck%cards%variations(i)%name%text, "-")
  end do
  call open_outputs(trim(folder), deck%model, no_inputs, parameters, .false., outputs, error)
  if (allocated(error)) then
    write (error_unit, "(a)") rendered(error)
    stop 2, quiet=.true.
  end if
  job%deck => deck
  job%outputs => outputs
  call begin_variant_job(job, 2, 1, 1)
  recorded%inner => job
  allocate (recorded%computing(count), recorded%writing(count), recorded%bytes(count))
  call run_tasks(recorded, 1, count, 1, no_journal, -1, 2)
  call discard_outputs(outputs)
  open (newunit=unit, file=trim(record), status="replace", action="write")
  write (unit, "(a)") "# computing [s]  bytes  writing [s]"
  do i = 1, count
    write (unit, "(es12.5, i9, es12.5)") recorded%computing(i), recorded%bytes(i), recorded%writing(i)
  end do
  close (unit)

end program record_tasks
