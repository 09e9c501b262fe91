// Presses a soft object from C# by P/Invoke, as a plug-in of Unity does, and prints the force on the fingertip.
//   mcs Press.cs && mono Press.exe SCENE.toml
using System;
using System.Globalization;
using System.Runtime.InteropServices;
using System.Text;

[StructLayout(LayoutKind.Sequential)]
public struct Vector
{
    public double x, y, z;
}

// irdm_command, irdm_stylus and irdm_object of irdm.h.
[StructLayout(LayoutKind.Sequential)]
public struct Command
{
    public uint present, buttons;
    public Vector tip;
    public double w, x, y, z;
}

[StructLayout(LayoutKind.Sequential)]
public struct Stylus
{
    public int present, contact, touched, tool;
    public Vector tip, proxy, force, torque;
}

[StructLayout(LayoutKind.Sequential)]
public struct Body
{
    public int asleep, solved;
    public Vector position;
    public double w, x, y, z;
    public Vector velocity, angularVelocity;
    public double residual;
    public double energy;
}

public static class Irdm
{
    const string Library = "libirdm.so.1";

    [DllImport(Library)]
    public static extern int irdm_simulation_open(string file, out IntPtr simulation, StringBuilder message, UIntPtr size);
    [DllImport(Library)]
    public static extern void irdm_simulation_close(IntPtr simulation);
    [DllImport(Library)]
    public static extern double irdm_simulation_dt(IntPtr simulation);
    [DllImport(Library)]
    public static extern int irdm_simulation_step(IntPtr simulation, Command[] commands, UIntPtr count, [Out] Stylus[] styluses);
    [DllImport(Library)]
    public static extern int irdm_simulation_objects(IntPtr simulation, [Out] Body[] objects, UIntPtr capacity);
}

public static class Press
{
    const int Steps = 400;

    static void Check(int status)
    {
        if (status != 0) throw new InvalidOperationException("irdm: status " + status);
    }

    static void Run(IntPtr simulation)
    {
        double dt = Irdm.irdm_simulation_dt(simulation);
        var commands = new Command[1];
        var styluses = new Stylus[1];
        var objects = new Body[1];
        double impulse = 0;
        for (int k = 0; k < Steps; ++k)
        {
            commands[0].present = 1;
            commands[0].tip.y = 0.075 - Math.Min(0.0001 * k, 0.02);
            Check(Irdm.irdm_simulation_step(simulation, commands, (UIntPtr)1, styluses));
            impulse -= styluses[0].force.y * dt;
            if (k % 50 == 49) Console.WriteLine("{0:F3} s  {1,8:F5} N", (k + 1) * dt, styluses[0].force.y);
        }
        Check(Irdm.irdm_simulation_objects(simulation, objects, (UIntPtr)1));
        Console.WriteLine("impulse {0:F9} N s, velocity {1:F9} m/s", impulse, objects[0].velocity.y);
    }

    public static int Main(string[] arguments)
    {
        CultureInfo.DefaultThreadCurrentCulture = CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
        if (arguments.Length != 1)
        {
            Console.Error.WriteLine("usage: Press.exe SCENE.toml");
            return 2;
        }
        var message = new StringBuilder(256);
        IntPtr simulation;
        if (Irdm.irdm_simulation_open(arguments[0], out simulation, message, (UIntPtr)message.Capacity) != 0)
        {
            Console.Error.WriteLine("Press: error: " + message);
            return 1;
        }
        try
        {
            Run(simulation);
            return 0;
        }
        finally
        {
            Irdm.irdm_simulation_close(simulation);
        }
    }
}
