!> The request of a deck to `sizing_study`.
module sizing_requests
  use models, only: has_law, model_t, report_number, runs_in_time
  use sizing_study, only: gear_t, sizing_request_t
  implicit none (type, external)
  private

  public :: sizing_request_of

contains

  !> Speeds, or laws and their instants, the fluctuation asked for, and the gear of the motor.
  pure function sizing_request_of(model) result(request)
    type(model_t), intent(in) :: model !! with REPORT sizing
    type(sizing_request_t) :: request

    request%speed = model%speed%value
    request%acceleration = model%acceleration
    request%fluctuation = model%reports(report_number(model, "sizing"))%fluctuation
    if (has_law(model)) then
      request%times = model%time%value
      if (.not. runs_in_time(model)) request%program = model%program
    end if
    associate (motor => model%motor)
      request%gear = gear_t(motor%ratio, motor%rotor, motor%efficiency, motor%smooth)
    end associate
  end function sizing_request_of

end module sizing_requests
