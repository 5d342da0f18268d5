!> What a run computed, and how long it took.
module run_statistics
  use beam_mesh, only: beam_mesh_t
  use deformation_model, only: deformation_model_t
  use kinds, only: wp
  use run_totals, only: run_totals_t
  use sweeps, only: sweep_t
  use text, only: plural, to_string
  use vibration_models, only: by_band, by_dense, by_link_modes, by_orders
  implicit none (type, external)
  private

  public :: run_times_t, statistics_text, sweep_summary, accuracy_summary

  !> Times of the parts of a run, besides those in its totals.
  type :: run_times_t
    real(wp) :: variants = 0.0_wp !! all variants, computed and written [s]
    real(wp) :: files = 0.0_wp    !! texts written, files put in place [s]
  end type run_times_t

contains

  !> The ledger of `--stats`.
  pure function statistics_text(name, totals, times) result(text)
    character(len=*), intent(in) :: name     !! of the deck
    type(run_totals_t), intent(in) :: totals !! over all variants
    type(run_times_t), intent(in) :: times   !! what the totals do not have
    character(len=:), allocatable :: text

    character(len=*), parameter :: line_feed = achar(10)

    text = name//":"
    if (totals%variants > 1) text = text//" variants "//to_string(totals%variants)//","
    text = text//" rows "//to_string(totals%rows)//", positions "//to_string(totals%positions)// &
      ", kinematic solutions "//to_string(totals%kinematic_solutions)//line_feed
    if (totals%motion_steps > 0) then
      text = text//name//": steps of forward motion "//to_string(totals%motion_steps)//line_feed
    end if
    if (totals%response_speeds > 0) then
      text = text//name//": elastic response at "//plural(int(totals%response_speeds), "speed")// &
        ", applications of its equation "//to_string(totals%applications)//line_feed
    end if
    if (totals%has_frequencies) then
      text = text//frequency_lines(name, totals)
    else if (totals%response_speeds == 0) then
      text = text//name//": skipped beams, matrices and eigenproblems: no report needs them"// &
        line_feed
    end if
    text = text//name//": "
    if (totals%variants > 1) text = text//"variants "//milliseconds(times%variants)// &
      " (all threads: "
    text = text//"computing "//milliseconds(totals%computing)//", writing "// &
      milliseconds(totals%writing)
    if (totals%variants > 1) text = text//")"
    text = text//", files "//milliseconds(times%files)//line_feed
  end function statistics_text

  !> `12.3 ms`
  pure function milliseconds(seconds) result(text)
    real(wp), intent(in) :: seconds
    character(len=:), allocatable :: text

    text = to_string(1000.0_wp*seconds, 3)//" ms"
  end function milliseconds

  !> The work that frequencies took, and what was skipped.
  pure function frequency_lines(name, totals) result(text)
    character(len=*), intent(in) :: name
    type(run_totals_t), intent(in) :: totals
    character(len=:), allocatable :: text

    character(len=*), parameter :: line_feed = achar(10)

    associate (counts => totals%counts)
      text = name//": link models "//to_string(counts%link_models)//", mass matrices "// &
        to_string(counts%mass_matrices)//", stiffness matrices "// &
        to_string(counts%stiffness_matrices)//", geometric stiffness matrices "// &
        to_string(counts%geometric_matrices)//line_feed
      text = text//name//": eigenproblems started from neighbours "// &
        to_string(counts%extrapolated)//", from a few modes of every link "// &
        to_string(counts%reduced_solutions)//", solved in full "// &
        to_string(counts%full_solutions)//line_feed
      text = text//name//": factorizations, one per inverse iteration or count, "// &
        to_string(counts%factorizations)//line_feed
      text = text//name//": proofs that no mode is missing "//to_string(counts%proofs)// &
        ", mode shapes "//to_string(counts%shapes)//line_feed
      if (totals%positions < totals%rows) then
        text = text//name//": skipped "//plural(int(totals%rows - totals%positions), "row")// &
          ": computed already, a full turn away"//line_feed
      end if
      if (counts%geometric_matrices == 0) text = text//name// &
        ": skipped geometric stiffness: no loads of the motion"//line_feed
      if (counts%shapes == 0) text = text//name//": skipped mode shapes: none requested"// &
        line_feed
      if (totals%speeds > 1) then
        text = text//name//": skipped kinematics, mass and unit loads of "// &
          plural(totals%speeds - 1, "more speed")//": those of the first are used"//line_feed
      end if
    end associate
  end function frequency_lines

  !> How the frequencies were found, for the log.
  pure function sweep_summary(sweep, mesh) result(text)
    type(sweep_t), intent(in) :: sweep     !! finished
    type(beam_mesh_t), intent(in) :: mesh  !! of the deck
    character(len=:), allocatable :: text

    character(len=*), parameter :: line_feed = achar(10)
    integer :: unknowns

    unknowns = mesh%unknowns
    if (.not. all(sweep%models%continuum%links%bends) .and. sweep%request%method == &
      by_link_modes) unknowns = sweep%models%mesh%layout%unknowns
    select case (sweep%request%method)
    case (by_orders)
      text = "orders chosen by the program, one element per link"// &
        between_masses(sweep%models%continuum)//": "//orders_of(sweep%models%continuum)
      if (sweep%models%continuum%mixed) then
        text = text//", solved in mixed form"
      else
        text = text//", solved in deformation coordinates: "// &
          to_string(sweep%models%continuum%layout%unknowns)//" unknowns"
      end if
    case (by_link_modes)
      text = "mesh of the deck, solved in deformation coordinates: "//to_string(unknowns)// &
        " unknowns"
    case (by_dense)
      text = "mesh of the deck, solved in nodal displacements by dsygvx (LAPACK): "// &
        to_string(mesh%unknowns)//" unknowns"
    case default
      text = "mesh of the deck, solved in nodal displacements by shift and invert on dpbtrf "// &
        "(ARPACK): "//to_string(mesh%unknowns)//" unknowns, half bandwidth "// &
        to_string(mesh%half_bandwidth)
    end select
    if (sweep%request%method /= by_orders) then
      text = text//line_feed//"errors estimated with continuous links of orders "// &
        orders_of(sweep%models%continuum)//": "// &
        to_string(sweep%models%continuum%layout%unknowns)//" unknowns"
    end if
    text = text//line_feed
  end function sweep_summary

  !> The error bound of the frequencies, and whether all modes were found, for the log.
  pure function accuracy_summary(method, largest) result(text)
    integer, intent(in) :: method    !! as in `vibration_models`
    real(wp), intent(in) :: largest  !! relative error of any frequency; below 0: no frequencies
    character(len=:), allocatable :: text

    character(len=*), parameter :: line_feed = achar(10)

    text = ""
    if (largest < 0.0_wp) return
    if (largest > 1.0_wp) then
      text = "some frequencies are not known to any digit: see the error columns"//line_feed
      return
    end if
    text = "estimated relative error of every frequency: at most "//to_string(largest, 2)// &
      "; none is missing "
    if (any(method == [by_dense, by_band])) then
      text = text//"(counted with the same matrices)"//line_feed
    else
      text = text//"(proven)"//line_feed
    end if
  end function accuracy_summary

  !> Links with masses along them have more elements than one.
  pure function between_masses(model) result(text)
    type(deformation_model_t), intent(in) :: model
    character(len=:), allocatable :: text

    text = ""
    if (any(model%links%bending_shapes%elements > 1)) text = ", or between masses"
  end function between_masses

  !> `10, 12, rigid`
  pure function orders_of(model) result(text)
    type(deformation_model_t), intent(in) :: model
    character(len=:), allocatable :: text

    integer :: i

    text = ""
    do i = 1, size(model%order)
      if (i > 1) text = text//", "
      if (model%links(i)%bends) then
        text = text//to_string(model%order(i))
      else
        text = text//"rigid"
      end if
    end do
  end function orders_of

end module run_statistics
