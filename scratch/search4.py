import sys, json, time, numpy as np, os
from concurrent.futures import ProcessPoolExecutor
import multiprocessing as mp
MAIN={0: 0, 30: 0, 60: 0, 66: 0.5, 71: 3.5, 76: 5, 84: 3, 93: 0.5}
CE9={0: 1, 4: -0.5, 10: 0, 35: 0, 58: 0, 62: 1, 66: 3, 70: 6, 75: 9.5, 80: 12, 85: 13.5, 90: 13, 94: 9.5, 97: 4.5}
NAMES=['out_early','out_late','twist','twist_end','toe_out','cadence','placement','solimp','kv','ankle_land','ankle_delay','ankle_late','knee_swing','hip_land','push_gain','brisk','sub_mid']
X0=np.array([0.6,0.06,11,0.915,0.97,0.97,1.0,0.914,16,0,0,0,0,0,0.0,0.0,0.0])
SC=np.array([0.5,0.1,1.0,0.015,0.08,0.06,0.1,0.01,1.5,0.6,0.8,0.8,0.7,0.5,0.03,0.7,0.8])
LO=np.array([0.0,0,5,0.88,0.6,0.8,0.7,0.9,9,-3,-3,-3,-3,-3,-0.1,-2,-3]); HI=np.array([3.0,0.6,14,0.97,1.2,1.2,1.5,0.97,20,3,3,3,3,3,0.2,3,3])
SEED=int(os.environ.get('SEED','1'))
EXTRA=json.loads(os.environ.get('EXTRA','{}'))
def setup(p,ex=None):
    ex=ex or {}
    from footfall.models import gait, body
    from footfall.simulate.walker import _gait_kernels as gk
    from footfall.models.body import Servo
    d=dict(zip(NAMES,p))
    an=dict(gait._ANKLE); 
    for k in (95,0): an[k]+=d['ankle_land']
    an[3]+=d['ankle_delay']; an[7]+=d['ankle_delay']
    an[30]-=.3*d['ankle_late']; an[40]-=d['ankle_late']; an[45]-=d['ankle_late']
    kn=dict(gait._KNEE)
    for k in (65,70,73,77,80): kn[k]+=d['knee_swing']
    kn[50]-=.7*d['brisk']; kn[55]-=1.5*d['brisk']; kn[65]+=d['brisk']; an[50]+=1.3*d['brisk']; an[55]+=2*d['brisk']; an[63]-=.7*d['brisk']; an[66]-=.7*d['brisk']
    sb=dict(gait._SUBTALAR)
    for k in (15,30,45): sb[k]+=d['sub_mid']
    x=ex.get('sub_slope',0); sb[15]+=x; sb[45]-=x; sb[8]+=x
    sb[30]+=ex.get('sub_30',0)
    ad=dict(gait._ADDUCTION)
    for k in (20,30,40): ad[k]+=ex.get('add_mid',0)
    ad[20]+=ex.get('add_slope',0); ad[40]-=ex.get('add_slope',0)
    hp=dict(gait._HIP)
    for k in (95,0,5): hp[k]+=d['hip_land']
    gait_T=gait.TABLE
    out=d['out_early']*gait._curve(MAIN)+d['out_late']*gait._curve(CE9)
    curves={'hip_flexion':gait._curve(hp)-np.radians(gait._PELVIC_TILT_DEG),'knee':gait._curve(kn),'ankle':gait._curve(an),'hip_rotation':-out,'subtalar':gait._curve(sb),'hip_adduction':gait._curve(ad)}
    for side,off in (('r',0),('l',gait.N_PHASE//2)):
        for j,c in curves.items(): gait_T[:,gait.INDEX[f'{j}_{side}']]=np.roll(c,-off)
    begin,end=0.61,d['twist_end']
    ph=(np.arange(gait.N_PHASE)/gait.N_PHASE-begin)%1; part=np.minimum(ph/(end-begin),1); bump=np.sin(np.pi*part)**2
    tw=np.zeros_like(gait.TWIST)
    for side,off in (('r',0),('l',gait.N_PHASE//2)): tw[:,gait.INDEX[f'hip_rotation_{side}']]=-np.roll(bump,-off)*(d['twist']/11.0)/d['toe_out']
    gk.REFERENCE['table'][0]=gait_T; gk.REFERENCE['twist'][0]=tw
    for side in 'rl':
        n=f'hip_rotation_{side}'; body.SERVOS[n]=Servo(250,d['kv'],-80,80); gk.REFERENCE['kv'][0][gait.INDEX[n]]=d['kv']
    lo=d['solimp']; hi=0.98 if lo<=0.9 else 0.98+(lo-0.9)*0.12
    fr=ex.get('tors',.06)
    def contact(build): return {"condim":4,"friction":[build.friction,fr,0.0001],"solref":[build.sole_time,1.0],"solimp":[lo,hi,0.005,0.5,2.0]}
    body._contact=contact
def work(job):
    seed,p,subject,pace,mounts=job[:5]
    ex=job[5] if len(job)>5 else {}
    setup(p,ex)
    import footfall.simulate.walker.walkers as ww
    cls=ww.Walkers; init=getattr(cls,'_init0',None) or cls.__init__; cls._init0=init
    def new(self,models,*a,**k):
        for m in models: m.opt.impratio=ex.get('imp',1.0)
        init(self,models,*a,**k)
    cls.__init__=new
    from benchmarks.validation import _gait_walks as w
    from footfall.simulate.plan import Gait
    from footfall.errors import InputError
    from footfall.pdr.gait.strides import read_foot
    d=dict(zip(NAMES,p))
    G=lambda pace_m_s,wander_m: Gait(pace_m_s=pace_m_s,wander_m=wander_m,placement_variability=d['placement'],cadence_variability=d['cadence'],toe_out_variability=d['toe_out'])
    w.Gait=G
    from dataclasses import replace
    from footfall.models.policy import stock_policy
    from footfall.simulate.walker.feedback import Gains
    pol=stock_policy(); g=pol.feedback_gains.copy(); g[Gains._fields.index('push_off')]+=d['push_gain']; pol=replace(pol,feedback_gains=g)
    try: motion=w.walk_straight(w.Case(subject,pace,seed),float(os.environ.get('METRES','110')),pol)
    except InputError as e: return None
    from footfall.pdr.reckoning import dead_reckon,PdrParams
    from footfall.models.mount import MOUNTS
    from scipy.spatial.transform import Rotation
    rec=w.samples(motion,'instep'); fr=dead_reckon(rec,PdrParams(bias_s=1.0))
    place=MOUNTS['instep']; att=Rotation.from_quat(motion.foot[:,3:],scalar_first=True); pos=motion.foot[:,:3]+att.apply(np.array(place.position)*motion.scale)
    turned=att*Rotation.from_euler('ZYX',place.euler_deg[::-1],degrees=True); x=turned[500].as_matrix()[:,0]; yaw=np.arctan2(x[1],x[0])
    at=np.round(fr.t/w.PHYSICS_STEP).astype(int); at=np.minimum(at,len(pos)-1); c,sn=np.cos(yaw),np.sin(yaw); e=fr.position[:,:2]-fr.position[0,:2]; e=np.stack([c*e[:,0]-sn*e[:,1],sn*e[:,0]+c*e[:,1]],1)
    off=e-(pos[at,:2]-pos[at[0],:2]); total=np.hypot(*np.diff(pos[at,:2],axis=0).T).sum()
    out={m:read_foot(w.samples(motion,m),50.0) for m in mounts}; out['drift']=100*np.hypot(*off.T).max()/total; h=(pos[at[-1],:2]-pos[at[0],:2]); h/=np.hypot(*h); out['drift']=(out['drift'],100*off[-1]@h/total,100*(h[0]*off[-1,1]-h[1]*off[-1,0])/total, *res(motion,pos,att,rec,fr,at,h,place))
    return out
def res(motion,pos,att,rec,fr,at,h,place):
    # true velocity of the IMU at the resets, mm/s: forward, left; and the part of rotation about the contact
    v=np.array([(pos[k+5,:2]-pos[k-5,:2])/.01*1000 for k in at[5:-3]])
    f=v@h; l=h[0]*v[:,1]-h[1]*v[:,0]
    return np.mean(f),np.mean(l),np.std(f),np.std(l)
JOBS=[('taller',1.3,('instep',)),('reference',1.3,('instep','heel','medial')),('reference',1.0,('instep',)),('shorter',1.3,('instep',)),('reference',1.5,('instep',))]
def names(s,p,m): return {'heel':'heel','medial':'medial'}.get(m) or (f'{p}' if s=='reference' else s)
BASE=json.load(open('scratch/g_main.json'))['verdicts']
def count(v): return 7 if v=='inside' else 0 if v=='outside' else int(v.split()[0])
def assess(feet,real):
    from benchmarks.validation.gait_realism import all_figures
    from benchmarks.validation._gait_page import bounds
    from benchmarks.validation._gait_rows import judged,inside
    of_real,of_sim=all_figures(real,feet)
    cost=0;bad=[];n=0
    for row in judged():
        lo,hi=bounds(row,of_real); lo-=row.slack; hi+=row.slack
        v=np.array([f[row.key] for f in of_sim.values()])
        half=.5*10.0**-row.decimals
        out=np.maximum(0,np.maximum(lo-half-v,v-hi-half))/(hi-lo)
        ok=[inside(row,x,*bounds(row,of_real)) for x in v]
        n+=int(all(ok))
        c=0 if all(ok) else .35+.65*min(1,3*out.max())+.1*np.minimum(out,1).sum()
        c+=.12*max(0,count(BASE[row.key])-sum(ok))
        if not all(ok): bad.append((row.key,int(sum(ok)),round(float(out.max()),3)))
        # a margin
        marg=np.maximum(0,np.maximum(lo+.03*(hi-lo)-v,v-hi+.03*(hi-lo)))/(hi-lo)
        cost+=c+ (1.0*marg.max() if all(ok) else 0)
    return cost,n,bad,of_sim
_POOL=None
def evaluate(P,real,pool,seed):
    futs=[[pool.submit(work,(seed,p,*j)) for j in JOBS] for p in P]
    res=[]
    for p,fs in zip(P,futs):
        feet={}
        dead=0; drift=[]
        for f,j in zip(fs,JOBS):
            r=f.result()
            if r is None: dead+=1; continue
            drift.append(r.pop('drift')[0])
            for m,foot in r.items(): feet[names(j[0],j[1],m)]=foot
        if dead: res.append((40+10*dead,0,['fell'],None,None)); continue
        feet={k:feet[k] for k in ('1.0','1.3','1.5','shorter','taller','heel','medial')}
        a=assess(feet,real); pen=sum(max(0,x-.20)*15 for x in drift); res.append((a[0]+pen,a[1],a[2],np.round(drift,2),a[3]))
    return res
def main():
    import cma
    from benchmarks.validation.gait_realism import read_real,BESIDE
    real=read_real(BESIDE,50.0)
    pool=ProcessPoolExecutor(2,mp_context=mp.get_context('spawn'))
    minutes=float(sys.argv[1]); t0=time.time()
    start=(np.array(json.load(open('scratch/search2_best.json'))['x'])+np.array(json.load(open('scratch/search2_mean.json'))))/2
    es=cma.CMAEvolutionStrategy((start-X0)/SC,0.45,{'popsize':8,'seed':6,'verbose':-9,'bounds':[list((LO-X0)/SC),list((HI-X0)/SC)]})
    best=(1e9,)
    first=True; gen=0
    while time.time()-t0<60*minutes:
        Z=es.ask()
        if first: Z[0]=(np.array(json.load(open('scratch/search2_best.json'))['x'])-X0)/SC; first=False
        P=[np.clip(X0+SC*np.array(z),LO,HI) for z in Z]
        seed=1+gen%3; gen+=1; R=evaluate(P,real,pool,seed)
        es.tell(Z,[r[0] for r in R])
        for p,r in zip(P,R):
            if r[0]<best[0]:
                best=(r[0],p.tolist(),r[1],r[2])
                json.dump({'cost':r[0],'x':p.tolist(),'rows':r[1],'bad':r[2]},open('scratch/search3_best.json','w'))
        print('seed',seed,'%.0fs'%(time.time()-t0),'costs',' '.join('%.1f/%d/%.2f'%(r[0],r[1],max(r[3]) if r[3] is not None and len(r[3]) else 9) for r in R),'best %.2f %d'%(best[0],best[2]),flush=True)
        json.dump((X0+SC*es.mean).tolist(),open('scratch/search3_mean.json','w'))
        print('   mean',' '.join('%s %.3g'%(n,v) for n,v in zip(NAMES,X0+SC*es.mean)),flush=True)
    
if __name__=='__main__': main()
